#include "sim/tissue/structure/structure_formulas.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include "sim/core/hash.h"
#include "sim/core/smooth_noise.h"

namespace insonate {
namespace {

float share(float x) {
  return std::clamp(x, 0.0f, 1.0f);
}

float sheet(float noise, float width) {
  return share(1.6f * (1.0f - std::abs(noise) / width));
}

float tube(float r, float at, float half_width) {
  return share(1.6f * (1.0f - std::abs(r - at) / half_width));
}

/// The formulas of tissue_structure.h, for one seed and size of a voxel.
struct Terms {
  std::uint32_t seed;
  float widened;

  std::vector<float> at(Structure structure, const StructurePlaces& p) const {
    switch (structure) {
      case Structure::none:
        break;
      case Structure::even:
      case Structure::medulla:
        return times(0.4f, noise(1, p, 2));
      case Structure::glandular:
        return times(2.2f, noise(2, p, 3.5f));
      case Structure::sinus:
        return sinus(p);
      case Structure::mixed:
        return sum(times(2.5f, noise(4, p, 6)), times(1.5f, noise(5, p, 2.5f)));
      case Structure::organ:
        return organ(p);
      case Structure::muscle:
        return sum(sheets(30, p, {16, 30, 3.2f}, 11, 0.7f), times(2, layered(10, p, {5, 30, 1.7f})));
      case Structure::fat:
        return sum(sheets(40, p, {16, 16, 4}, 11, 0.65f), times(0.7f, noise(13, p, 5)));
      case Structure::kidney:
        return sum(pyramids(p), times(0.4f, noise(1, p, 2)));
    }
    return std::vector<float>(p.size());
  }

  struct Stretch {
    float across_mm, along_mm, apart_mm;
  };

  std::vector<float> noise(std::uint32_t layer, const std::vector<float>& x, const std::vector<float>& y,
                           const std::vector<float>& z) const {
    std::vector<float> values(x.size());
    smooth_noise(hash(seed, layer), x.data(), y.data(), z.data(), x.size(), values.data());
    return values;
  }

  std::vector<float> noise(std::uint32_t layer, const StructurePlaces& p, float grain_mm) const {
    return noise(layer, times(1 / grain_mm, p.x), times(1 / grain_mm, p.y), times(1 / grain_mm, p.z));
  }

  static std::vector<float> times(float factor, std::vector<float> values) {
    for (float& value : values) value *= factor;
    return values;
  }

  static std::vector<float> sum(std::vector<float> a, const std::vector<float>& b) {
    for (std::size_t n = 0; n < a.size(); ++n) a[n] += b[n];
    return a;
  }

  /// Returns the distance from the lines on which two noises are zero, mm.
  std::vector<float> from_lines(std::uint32_t layer, const StructurePlaces& p, float grain_mm) const {
    constexpr float kSlope = 2.6f;  // mean slope of the noise at its zeros, per grain, measured over 10^6 points
    std::vector<float> r = noise(layer, p, grain_mm);
    const std::vector<float> other = noise(layer + 1, p, grain_mm);
    for (std::size_t n = 0; n < r.size(); ++n) r[n] = std::sqrt(r[n] * r[n] + other[n] * other[n]) * grain_mm / kSlope;
    return r;
  }

  std::vector<float> organ(const StructurePlaces& p) const {
    const std::vector<float> portal = from_lines(20, p, 14), vein = from_lines(22, p, 16);
    const std::vector<float> fade = noise(24, p, 18), other_fade = noise(25, p, 18), mottle = noise(26, p, 8);
    std::vector<float> db(p.size());
    for (std::size_t n = 0; n < db.size(); ++n) {
      const float wall = 9 * tube(portal[n], 1.8f, 1.6f * widened), lumen = 8 * tube(portal[n], 0, widened);
      db[n] = share(0.5f + fade[n]) * (wall - lumen) -
              share(0.5f + other_fade[n]) * 8 * tube(vein[n], 0, 2.0f * widened) + 0.5f * mottle[n];
    }
    return db;
  }

  std::vector<float> sinus(const StructurePlaces& p) const {
    const std::vector<float> patches = noise(3, p, 5), grain = noise(60, p, 2.5f), uneven = noise(61, p, 6);
    const std::vector<float> branch = from_lines(62, p, 11);
    std::vector<float> db(p.size());
    for (std::size_t n = 0; n < db.size(); ++n) {
      db[n] = 2.5f * patches[n] + 1.5f * grain[n] - 9 * tube(branch[n], 0, 1.3f * widened);
      if (!p.from_parenchyma.empty()) db[n] -= 7 * (1 - share((p.from_parenchyma[n] + 2 * uneven[n]) / 5));
    }
    return db;
  }

  /// Returns noise that is stretched along the skin: the header's N(q).
  std::vector<float> layered(std::uint32_t layer, const StructurePlaces& p, const Stretch& q) const {
    const glm::vec3 deep = glm::normalize(glm::vec3(0.6f, 0.5f, 0.62f));
    std::vector<float> x(p.size()), y(p.size()), z(p.size());
    for (std::size_t n = 0; n < p.size(); ++n) {
      const float d = p.depth[n] / q.apart_mm;
      x[n] = p.x[n] / q.across_mm + deep.x * d;
      y[n] = p.y[n] / q.across_mm + deep.y * d;
      z[n] = p.z[n] / q.along_mm + deep.z * d;
    }
    return noise(layer, x, y, z);
  }

  /// Returns sheets whose brightness comes and goes.
  std::vector<float> sheets(std::uint32_t layer, const StructurePlaces& p, const Stretch& q, float peak_db,
                            float width) const {
    constexpr float kMeanSheet = 0.35f;  // so that modulation does not change the mean brightness
    std::vector<float> db = layered(layer, p, q);
    const std::vector<float> modulation = noise(layer + 1, p, 20);
    for (std::size_t n = 0; n < db.size(); ++n)
      db[n] = peak_db * (0.65f + 0.35f * std::clamp(modulation[n], -1.0f, 1.0f)) *
              (sheet(db[n], width * widened) - kMeanSheet);
    return db;
  }

  std::vector<float> pyramids(const StructurePlaces& p) const {
    if (p.u.empty()) return std::vector<float>(p.size());
    constexpr float kGrain_mm = 9;
    std::vector<float> db = noise(50, times(1 / kGrain_mm, p.u), times(1 / kGrain_mm, p.v), times(1 / kGrain_mm, p.w));
    for (std::size_t n = 0; n < db.size(); ++n)
      db[n] = -7 * share(2 * db[n] + 0.6f) * share(6 * (0.72f - p.outwards[n]));
    return db;
  }
};

}  // namespace

StructureFormulas::StructureFormulas(std::uint32_t seed, float voxel_mm)
    : seed_(seed), widened_(std::max(1.0f, voxel_mm)) {
  for (std::size_t s = 0; s < kStructures; ++s) means_[s] = mean_of(Structure(s));
}

std::vector<float> StructureFormulas::at(Structure structure, const StructurePlaces& places) const {
  return Terms{seed_, widened_}.at(structure, places);
}

// The mean over 2^15 places in 1 m^3, whose depths are those of plane skin.
float StructureFormulas::mean_of(Structure structure) const {
  constexpr std::uint32_t kPlaces = 1u << 15;
  StructurePlaces p;
  for (std::uint32_t n = 0; n < kPlaces; ++n) {
    const glm::vec3 place(unit_float(hash(n, 0)), unit_float(hash(n, 1)), unit_float(hash(n, 2)));
    p.add(0, 1000.0f * place, 1000.0f * place.y, 1);
  }
  double total = 0;
  for (const float value : at(structure, p)) total += value;
  return float(total / kPlaces);
}

}  // namespace insonate
