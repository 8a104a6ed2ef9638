#include "sim/reference/display_reference.h"

#include <algorithm>
#include <cmath>

#include "sim/model/display_filter.h"
#include "sim/reference/reference.h"

namespace insonate {
namespace {

/// Maps a share of the dynamic range, 0 to 1, to grey, 0 to 1.
double grey_of(GreyMap map, double g) {
  switch (map) {
    case GreyMap::linear:
      return g;
    case GreyMap::soft:
      return std::pow(g, 0.75);
    case GreyMap::contrast:
      return std::pow(g, 1.5);
    case GreyMap::s_curve:
      return g * g * (3 - 2 * g);
  }
  return g;
}

/// Returns the compressed echo, 0 to 1: 1 at `level`, 0 if `echo` is 0 or lies the dynamic range below `level`.
double compressed(const Settings& settings, double echo, double level) {
  if (echo <= 0) return 0;
  return std::clamp(1 + 10 * std::log10(echo / level) / settings.dynamic_range_db, 0.0, 1.0);
}

/// Returns the compressed echo behind the display filter.
Image<double> filtered(const Image<double>& shown, const Image<std::uint8_t>& inside, const Settings& settings,
                       double mm_per_pixel, double of_speckle) {
  const double sigma = filter_sigma_mm(settings) / mm_per_pixel;
  const int radius = filter_radius_px(settings, mm_per_pixel);
  struct Sums {
    double weight = 0, first = 0, second = 0;
    void add(double w, const Sums& more) {
      weight += w * more.weight;
      first += w * more.first;
      second += w * more.second;
    }
  };
  const auto pass = [&](const Image<Sums>& from, int dx, int dy) {
    Image<Sums> to(from.width, from.height);
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x)
        for (int j = -radius; j <= radius && inside.at(x, y); ++j) {
          const int u = x + j * dx, v = y + j * dy;
          if (u >= 0 && v >= 0 && u < from.width && v < from.height)
            to.at(x, y).add(std::exp(-0.5 * j * j / (sigma * sigma)), from.at(u, v));
        }
    return to;
  };
  Image<Sums> sums(shown.width, shown.height);
  for (std::size_t i = 0; i < sums.pixels.size(); ++i)
    if (const double g = shown.pixels[i]; inside.pixels[i]) sums.pixels[i] = {1, g, g * g};
  sums = pass(pass(sums, 1, 0), 0, 1);
  Image<double> result = shown;
  for (std::size_t i = 0; i < sums.pixels.size(); ++i) {
    if (!inside.pixels[i]) continue;
    const Sums& here = sums.pixels[i];
    const double mean = here.first / here.weight, variance = here.second / here.weight - mean * mean;
    const double share = variance > of_speckle ? of_speckle / variance : 1;
    const double factor = settings.edge_enhancement * (1 - share) - settings.speckle_reduction * share;
    result.pixels[i] = std::clamp(shown.pixels[i] + factor * (shown.pixels[i] - mean), 0.0, 1.0);
  }
  return result;
}

std::uint8_t grey_byte(const Settings& settings, double g) {
  return std::uint8_t(std::lround(255 * grey_of(settings.grey_map, g)));
}

}  // namespace

double time_gain(const Settings& settings, double depth_share) {
  const double at = std::clamp(depth_share, 0.0, 1.0) * double(settings.tgc_db.size() - 1);
  const std::size_t below = std::min(std::size_t(at), settings.tgc_db.size() - 2);
  const double f = at - double(below);
  const double db = (1 - f) * settings.tgc_db[below] + f * settings.tgc_db[below + 1] + settings.gain_db;
  return std::pow(10.0, db / 10);
}

std::uint8_t grey_level(const Settings& settings, double echo, double level) {
  return grey_byte(settings, compressed(settings, echo, level));
}

Image<std::uint8_t> filtered_grey(const Image<double>& shown, const Image<std::uint8_t>& inside,
                                  const Settings& settings, double mm_per_pixel, int looks) {
  const Image<double> result = is_filtered(settings)
                                   ? filtered(shown, inside, settings, mm_per_pixel, speckle_variance(settings, looks))
                                   : shown;
  Image<std::uint8_t> grey(shown.width, shown.height);
  for (std::size_t i = 0; i < result.pixels.size(); ++i)
    if (inside.pixels[i]) grey.pixels[i] = grey_byte(settings, result.pixels[i]);
  return grey;
}

void show_reference(Stages<double>& stages, const Probe& probe, double depth_mm, const Settings& settings, int looks,
                    const Image<double>* frame_before) {
  const int w = settings.image_width, h = settings.image_height;
  const ImageGeometry geometry = image_geometry(probe, depth_mm, w, h);
  Image<double> echo(w, h);
  double brightest = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (const auto position = line_position(probe, depth_mm, geometry.plane_mm(x, y))) {
        echo.at(x, y) = heard(stages.fused.at(x, y)) * time_gain(settings, position->r_mm / depth_mm);
        brightest = std::max(brightest, echo.at(x, y));
      }
  const double level = settings.reference_level == ReferenceLevel::frame_maximum ? brightest : settings.fixed_level;
  stages.shown = Image<double>(w, h);
  for (std::size_t i = 0; i < echo.pixels.size(); ++i) {
    if (!stages.inside.pixels[i]) continue;
    const double now = compressed(settings, echo.pixels[i], level);
    stages.shown.pixels[i] = frame_before ? now + settings.persistence * (frame_before->pixels[i] - now) : now;
  }
  stages.grey = filtered_grey(stages.shown, stages.inside, settings, geometry.mm_per_pixel, looks);
}

}  // namespace insonate
