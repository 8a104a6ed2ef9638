#include "tools/bench/display.h"

#include <algorithm>
#include <cmath>

#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

double gain_db(const Settings& settings, double depth_share) {
  const double at = std::clamp(depth_share, 0.0, 1.0) * double(settings.tgc_db.size() - 1);
  const std::size_t below = std::min(std::size_t(at), settings.tgc_db.size() - 2);
  return settings.gain_db + std::lerp(settings.tgc_db[below], settings.tgc_db[below + 1], at - double(below));
}

}  // namespace

template <typename Real>
Display displayed(const Stages<Real>& stages, const Probe& probe, double depth_mm, const Settings& settings) {
  const int w = stages.fused.width, h = stages.fused.height;
  Display display{image_geometry(probe, depth_mm, w, h), stages.inside, Image<double>(w, h, -settings.dynamic_range_db),
                  Image<double>(w, h)};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      display.grey.at(x, y) = stages.grey.at(x, y);
      const auto position = line_position(probe, depth_mm, display.geometry.plane_mm(x, y));
      const double echo = double(stages.fused.at(x, y));
      if (!position || !(echo > 0)) continue;
      const double db = 10 * std::log10(echo / settings.fixed_level) + gain_db(settings, position->r_mm / depth_mm);
      display.db.at(x, y) = std::max(db, -settings.dynamic_range_db);
    }
  return display;
}

template Display displayed(const Stages<float>&, const Probe&, double, const Settings&);
template Display displayed(const Stages<double>&, const Probe&, double, const Settings&);

DisplayError error_of(const Display& shown, const Display& converged, double dynamic_range_db) {
  RootMeanSquare db_off, grey_off;
  for (int y = 0; y < converged.inside.height; ++y)
    for (int x = 0; x < converged.inside.width; ++x) {
      if (!converged.inside.at(x, y)) continue;
      const glm::dvec2 at = shown.geometry.pixel(converged.geometry.plane_mm(x, y));
      const int x0 = int(std::floor(at.x)), y0 = int(std::floor(at.y));
      double total = 0, db = 0, grey = 0;
      for (int corner = 0; corner < 4; ++corner) {
        const int u = x0 + (corner & 1), v = y0 + (corner >> 1);
        if (u < 0 || v < 0 || u >= shown.inside.width || v >= shown.inside.height || !shown.inside.at(u, v)) continue;
        const double weight = (1 - std::abs(at.x - u)) * (1 - std::abs(at.y - v));
        total += weight;
        db += weight * shown.db.at(u, v);
        grey += weight * shown.grey.at(u, v);
      }
      // Pixels without a neighbour in the other picture's fan stay black.
      db = total > 0 ? db / total : -dynamic_range_db;
      grey = total > 0 ? grey / total : 0;
      const double expected = converged.db.at(x, y);
      if (expected > -dynamic_range_db && expected < 0) db_off.add(db - expected);
      grey_off.add(grey - converged.grey.at(x, y));
    }
  return {db_off.value(), grey_off.value()};
}

}  // namespace insonate::bench
