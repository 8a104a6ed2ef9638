#include "sim/tissue/tissue_structure.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "sim/core/hash.h"
#include "sim/core/smooth_noise.h"

namespace insonate {
namespace {

constexpr int kStructures = int(Structure::sinus) + 1;

/// Scalars on a box of voxels, i fastest.
struct Field {
  glm::ivec3 size{0};
  std::vector<float> values;

  explicit Field(const glm::ivec3& s) : size(s), values(std::size_t(s.x) * std::size_t(s.y) * std::size_t(s.z)) {}
  std::size_t offset(const glm::ivec3& i) const {
    return (std::size_t(i.z) * std::size_t(size.y) + std::size_t(i.y)) * std::size_t(size.x) + std::size_t(i.x);
  }
  float at(const glm::ivec3& i) const { return values[offset(glm::clamp(i, glm::ivec3(0), size - 1))]; }
  float& at(const glm::ivec3& i) { return values[offset(i)]; }

  /// Trilinear between voxels, constant beyond the outermost.
  float between(const glm::vec3& index) const {
    const glm::vec3 p = glm::clamp(index, glm::vec3(0), glm::vec3(size - 1));
    const glm::ivec3 low = glm::min(glm::ivec3(p), glm::max(size - 2, 0)), high = glm::min(low + 1, size - 1);
    const glm::vec3 f = p - glm::vec3(low);
    const auto row = [&](int y, int z) { return glm::mix(at({low.x, y, z}), at({high.x, y, z}), f.x); };
    return glm::mix(glm::mix(row(low.y, low.z), row(high.y, low.z), f.y),
                    glm::mix(row(low.y, high.z), row(high.y, high.z), f.y), f.z);
  }

  /// Replaces each line along an axis by change(line).
  template <typename Change>
  void along(int axis, Change change) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    std::size_t stride = 1;
    for (int other = 0; other < axis; ++other) stride *= std::size_t(size[other]);
    tbb::parallel_for(tbb::blocked_range<int>(0, size[b]), [&](const auto& range) {
      const auto length = std::size_t(size[axis]);
      std::vector<float> line(length);
      for (int j = range.begin(); j != range.end(); ++j)
        for (int i = 0; i < size[a]; ++i) {
          glm::ivec3 start(0);
          start[a] = i;
          start[b] = j;
          float* first = values.data() + offset(start);
          for (std::size_t n = 0; n < line.size(); ++n) line[n] = first[n * stride];
          change(line);
          for (std::size_t n = 0; n < line.size(); ++n) first[n * stride] = line[n];
        }
    });
  }
};

/// Blurs by a Gaussian, whose weights at the border add up to 1 again.
void blur(Field& field, const glm::dvec3& spacing, double sigma_mm) {
  for (int axis = 0; axis < 3; ++axis) {
    const int reach = int(std::ceil(3 * sigma_mm / spacing[axis]));
    std::vector<float> weights;
    for (int i = -reach; i <= reach; ++i)
      weights.push_back(float(std::exp(-0.5 * std::pow(i * spacing[axis] / sigma_mm, 2))));
    field.along(axis, [&](std::vector<float>& line) {
      const std::vector<float> before = line;
      const int n = int(line.size());
      for (int i = 0; i < n; ++i) {
        float sum = 0, weight = 0;
        for (int j = std::max(0, i - reach); j <= std::min(n - 1, i + reach); ++j) {
          const float w = weights[std::size_t(j - i + reach)];
          sum += w * before[std::size_t(j)];
          weight += w;
        }
        line[std::size_t(i)] = sum / weight;
      }
    });
  }
}

/// Returns the distance from each voxel to the nearest one that is above 0, mm: exactly, axis by axis, as the lower
/// envelope of parabolas (Felzenszwalb and Huttenlocher, Theory of Computing 8, 2012).
Field distances_to(const Field& mask, const glm::dvec3& spacing) {
  constexpr float kFar = 1e8f;
  Field squared(mask.size);
  for (std::size_t v = 0; v < mask.values.size(); ++v) squared.values[v] = mask.values[v] > 0 ? 0 : kFar;
  for (int axis = 0; axis < 3; ++axis) {
    const float step = float(spacing[axis]);
    squared.along(axis, [&](std::vector<float>& line) {
      const std::vector<float> f = line;
      std::vector<int> lowest(f.size());
      std::vector<float> from(f.size() + 1);
      std::size_t last = 0;
      from[0] = -std::numeric_limits<float>::max();
      from[1] = std::numeric_limits<float>::max();
      const auto meet = [&](int q, int v) {
        const float a = float(q) * step, b = float(v) * step;
        return ((f[std::size_t(q)] + a * a) - (f[std::size_t(v)] + b * b)) / (2 * (a - b));
      };
      for (int q = 1; q < int(f.size()); ++q) {
        while (last > 0 && meet(q, lowest[last]) <= from[last]) --last;
        const float s = meet(q, lowest[last]);
        if (last > 0 || s > from[0]) ++last;
        lowest[last] = q;
        from[last] = s;
        from[last + 1] = std::numeric_limits<float>::max();
      }
      std::size_t k = 0;
      for (std::size_t q = 0; q < f.size(); ++q) {
        while (from[k + 1] < float(q) * step) ++k;
        const float away = (float(q) - float(lowest[k])) * step;
        line[q] = away * away + f[std::size_t(lowest[k])];
      }
    });
  }
  for (float& value : squared.values) value = std::sqrt(std::min(value, kFar));
  return squared;
}

/// Where a voxel lies in the body, on a grid of some 3 mm.
class Surroundings {
public:
  explicit Surroundings(const Volume<std::int16_t>& ct)
      : step_(glm::max(glm::ivec3(glm::round(3.0 / ct.grid.spacing)), 1)),
        depth_mm_((ct.grid.size + step_ - 1) / step_),
        soft_(depth_mm_.size) {
    const glm::dvec3 spacing = ct.grid.spacing * glm::dvec3(step_);
    Field outside(depth_mm_.size);
    std::vector<glm::ivec3> reached;
    const auto reach = [&](const glm::ivec3& i) {
      if (outside.at(i) > 0 || ct.at(i * step_) > kMostAirHu) return;
      outside.at(i) = 1;
      reached.push_back(i);
    };
    const glm::ivec3 size = outside.size;
    for (int axis = 0; axis < 3; ++axis)
      if (is_across(ct.grid, axis)) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (int i = 0; i < size[a]; ++i)
          for (int j = 0; j < size[b]; ++j)
            for (const int end : {0, size[axis] - 1}) {
              glm::ivec3 at(0);
              at[axis] = end;
              at[a] = i;
              at[b] = j;
              reach(at);
              outside.at(at) = 1;
            }
      }
    while (!reached.empty()) {
      const glm::ivec3 from = reached.back();
      reached.pop_back();
      for (int axis = 0; axis < 3; ++axis)
        for (const int way : {-1, 1}) {
          glm::ivec3 to = from;
          to[axis] += way;
          if (to[axis] >= 0 && to[axis] < size[axis]) reach(to);
        }
    }
    depth_mm_ = distances_to(outside, spacing);
    blur(depth_mm_, spacing, kDepthBlur_mm);
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const int hu = ct.at(glm::ivec3(x, y, z) * step_);
          soft_.at({x, y, z}) = hu > 0 && hu < 130 ? 1.0f : 0.0f;
        }
    blur(soft_, spacing, kSoftBlur_mm);
  }

  float depth_mm(const glm::ivec3& i) const { return depth_mm_.between(glm::vec3(i) / glm::vec3(step_)); }
  float soft_share(const glm::ivec3& i) const { return soft_.between(glm::vec3(i) / glm::vec3(step_)); }

private:
  static constexpr double kDepthBlur_mm = 5, kSoftBlur_mm = 8;

  /// True for an axis that leads out of the body at its sides, not at the head's and the feet's end.
  static bool is_across(const Grid& grid, int axis) {
    for (int other = 0; other < 3; ++other)
      if (std::abs(grid.direction[other].z) > std::abs(grid.direction[axis].z)) return true;
    return false;
  }

  glm::ivec3 step_;
  Field depth_mm_, soft_;
};

/// The box around a label's voxels with a margin, within the grid. Its size is 0 if there are none.
struct LabelBox {
  glm::ivec3 low{0}, size{0};

  LabelBox(const Volume<std::uint8_t>& labels, int label) {
    const glm::ivec3 grid = labels.grid.size;
    glm::ivec3 least = grid, most(-1);
    std::size_t v = 0;
    for (int z = 0; z < grid.z; ++z)
      for (int y = 0; y < grid.y; ++y)
        for (int x = 0; x < grid.x; ++x, ++v)
          if (labels.voxels[v] == label) {
            least = glm::min(least, {x, y, z});
            most = glm::max(most, {x, y, z});
          }
    if (most.x < 0) return;
    constexpr int kMargin = 3;
    low = glm::max(least - kMargin, 0);
    size = glm::min(most + kMargin, grid - 1) - low + 1;
  }
};

/// How far the voxels of a sinus lie from the kidney's parenchyma, mm.
class SinusRim {
public:
  SinusRim(const Volume<std::uint8_t>& labels, int label, const std::array<Structure, kLabelValues>& structure_of)
      : box_(labels, label), from_parenchyma_(box_.size) {
    Field parenchyma(box_.size);
    for (int z = 0; z < box_.size.z; ++z)
      for (int y = 0; y < box_.size.y; ++y)
        for (int x = 0; x < box_.size.x; ++x) {
          const Structure here = structure_of[labels.at(box_.low + glm::ivec3(x, y, z))];
          parenchyma.at({x, y, z}) = here == Structure::kidney || here == Structure::medulla ? 1.0f : 0.0f;
        }
    from_parenchyma_ = distances_to(parenchyma, labels.grid.spacing);
  }

  float distance_mm(const glm::ivec3& voxel) const { return from_parenchyma_.at(voxel - box_.low); }

private:
  LabelBox box_;
  Field from_parenchyma_;
};

/// The pyramids of one kidney: where a voxel lies between sinus and capsule, and the nearest point of the sinus.
class Pyramids {
public:
  Pyramids(const Volume<std::uint8_t>& labels, int label, const std::array<Structure, kLabelValues>& structure_of)
      : grid_(labels.grid), from_sinus_(glm::ivec3(0)), from_capsule_(glm::ivec3(0)) {
    const LabelBox box(labels, label);
    low_ = box.low;
    const glm::ivec3 size = box.size;
    Field sinus(size), outside(size);
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const std::uint8_t here = labels.at(low_ + glm::ivec3(x, y, z));
          const bool is_sinus = structure_of[here] == Structure::sinus;
          has_sinus_ = has_sinus_ || is_sinus;
          sinus.at({x, y, z}) = is_sinus ? 1.0f : 0.0f;
          outside.at({x, y, z}) = is_sinus || here == label ? 0.0f : 1.0f;
        }
    if (!has_sinus_) return;
    from_sinus_ = distances_to(sinus, grid_.spacing);
    from_capsule_ = distances_to(outside, grid_.spacing);
    blur(from_sinus_, grid_.spacing, kBlur_mm);
    blur(from_capsule_, grid_.spacing, kBlur_mm);
  }

  bool exist() const { return has_sinus_; }

  struct Place {
    glm::dvec3 nearest_mm{0.0};  ///< of the sinus, patient
    float outwards = 0;          ///< 0 at the sinus, 1 at the capsule
  };
  Place at(const glm::ivec3& voxel) const {
    const glm::ivec3 i = voxel - low_;
    const float sinus = from_sinus_.at(i), capsule = from_capsule_.at(i);
    glm::dvec3 slope(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      glm::ivec3 step(0);
      step[axis] = 2;
      slope[axis] = (from_sinus_.at(i + step) - from_sinus_.at(i - step)) / (4 * grid_.spacing[axis]);
    }
    const double length = glm::length(slope);
    if (length > 0) slope *= double(sinus) / length;
    return {grid_.patient_from_index(glm::dvec3(voxel) - slope / grid_.spacing),
            sinus / std::max(sinus + capsule, 1e-3f)};
  }

private:
  static constexpr double kBlur_mm = 1.5;

  Grid grid_;
  glm::ivec3 low_{0};
  bool has_sinus_ = false;
  Field from_sinus_, from_capsule_;
};

float share(float x) {
  return std::clamp(x, 0.0f, 1.0f);
}

float sheet(float noise, float width) {
  return share(1.6f * (1.0f - std::abs(noise) / width));
}

float tube(float r, float at, float half_width) {
  return share(1.6f * (1.0f - std::abs(r - at) / half_width));
}

/// Places of one structure.
struct Places {
  std::vector<std::size_t> voxel;             ///< in the slice
  std::vector<float> x, y, z, depth, weight;  ///< patient mm; the structure's share
  std::vector<float> u, v, w, outwards;       ///< of kidneys alone: nearest point of the sinus, and Place::outwards
  std::vector<float> from_parenchyma;         ///< of a sinus beside a kidney alone, mm

  std::size_t size() const { return x.size(); }
  void add(std::size_t at, const glm::vec3& p, float depth_mm, float share_of) {
    voxel.push_back(at);
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
    depth.push_back(depth_mm);
    weight.push_back(share_of);
  }
};

/// Evaluates the formulas of the header, without their mean.
class Formulas {
public:
  Formulas(std::uint32_t seed, float voxel_mm) : seed_(seed), widened_(std::max(1.0f, voxel_mm)) {
    for (int s = 0; s < kStructures; ++s) means_[std::size_t(s)] = mean_of(Structure(s));
  }

  float mean(Structure structure) const { return means_[std::size_t(structure)]; }

  std::vector<float> at(Structure structure, const Places& p) const {
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

private:
  struct Stretch {
    float across_mm, along_mm, apart_mm;
  };

  std::vector<float> noise(std::uint32_t layer, const std::vector<float>& x, const std::vector<float>& y,
                           const std::vector<float>& z) const {
    std::vector<float> values(x.size());
    smooth_noise(hash(seed_, layer), x.data(), y.data(), z.data(), x.size(), values.data());
    return values;
  }

  std::vector<float> noise(std::uint32_t layer, const Places& p, float grain_mm) const {
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
  std::vector<float> from_lines(std::uint32_t layer, const Places& p, float grain_mm) const {
    constexpr float kSlope = 2.6f;  // mean slope of the noise at its zeros, per grain, measured over 10^6 points
    std::vector<float> r = noise(layer, p, grain_mm);
    const std::vector<float> other = noise(layer + 1, p, grain_mm);
    for (std::size_t n = 0; n < r.size(); ++n) r[n] = std::sqrt(r[n] * r[n] + other[n] * other[n]) * grain_mm / kSlope;
    return r;
  }

  std::vector<float> organ(const Places& p) const {
    const std::vector<float> portal = from_lines(20, p, 14), vein = from_lines(22, p, 16);
    const std::vector<float> fade = noise(24, p, 18), other_fade = noise(25, p, 18), mottle = noise(26, p, 8);
    std::vector<float> db(p.size());
    for (std::size_t n = 0; n < db.size(); ++n) {
      const float wall = 9 * tube(portal[n], 1.8f, 1.6f * widened_), lumen = 8 * tube(portal[n], 0, widened_);
      db[n] = share(0.5f + fade[n]) * (wall - lumen) -
              share(0.5f + other_fade[n]) * 8 * tube(vein[n], 0, 2.0f * widened_) + 0.5f * mottle[n];
    }
    return db;
  }

  std::vector<float> sinus(const Places& p) const {
    const std::vector<float> patches = noise(3, p, 5), grain = noise(60, p, 2.5f), uneven = noise(61, p, 6);
    const std::vector<float> branch = from_lines(62, p, 11);
    std::vector<float> db(p.size());
    for (std::size_t n = 0; n < db.size(); ++n) {
      db[n] = 2.5f * patches[n] + 1.5f * grain[n] - 9 * tube(branch[n], 0, 1.3f * widened_);
      if (!p.from_parenchyma.empty()) db[n] -= 7 * (1 - share((p.from_parenchyma[n] + 2 * uneven[n]) / 5));
    }
    return db;
  }

  /// Returns noise that is stretched along the skin: the header's N(q).
  std::vector<float> layered(std::uint32_t layer, const Places& p, const Stretch& q) const {
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
  std::vector<float> sheets(std::uint32_t layer, const Places& p, const Stretch& q, float peak_db, float width) const {
    constexpr float kMeanSheet = 0.35f;  // so that modulation does not change the mean brightness
    std::vector<float> db = layered(layer, p, q);
    const std::vector<float> modulation = noise(layer + 1, p, 20);
    for (std::size_t n = 0; n < db.size(); ++n)
      db[n] = peak_db * (0.65f + 0.35f * std::clamp(modulation[n], -1.0f, 1.0f)) *
              (sheet(db[n], width * widened_) - kMeanSheet);
    return db;
  }

  std::vector<float> pyramids(const Places& p) const {
    if (p.u.empty()) return std::vector<float>(p.size());
    constexpr float kGrain_mm = 9;
    std::vector<float> db = noise(50, times(1 / kGrain_mm, p.u), times(1 / kGrain_mm, p.v), times(1 / kGrain_mm, p.w));
    for (std::size_t n = 0; n < db.size(); ++n)
      db[n] = -7 * share(2 * db[n] + 0.6f) * share(6 * (0.72f - p.outwards[n]));
    return db;
  }

  /// Returns the mean over 2^15 places in 1 m^3, whose depths are those of plane skin.
  float mean_of(Structure structure) const {
    constexpr std::uint32_t kPlaces = 1u << 15;
    Places p;
    for (std::uint32_t n = 0; n < kPlaces; ++n) {
      const glm::vec3 at(unit_float(hash(n, 0)), unit_float(hash(n, 1)), unit_float(hash(n, 2)));
      p.add(0, 1000.0f * at, 1000.0f * at.y, 1);
    }
    double total = 0;
    for (const float value : this->at(structure, p)) total += value;
    return float(total / kPlaces);
  }

  std::uint32_t seed_;
  float widened_;  ///< factor on the thickness of sheets and lines
  std::array<float, kStructures> means_{};
};

float rising(float x, float from, float to) {
  return share((x - from) / (to - from));
}

/// Shares of an unlabelled voxel.
struct Shares {
  float fat = 0, muscle = 0, organ = 0;
};

Shares shares_of(float hu, float depth_mm, float soft_share, bool has_labels) {
  constexpr float kOrgan = 0.5f;  // strength, because what the tissue is remains a guess
  Shares shares;
  shares.fat = rising(hu, -150, -130) * rising(hu, -20, -45);
  const float soft = rising(hu, -45, -20) * rising(hu, 130, 100);
  const float thin = has_labels ? 1.0f : rising(soft_share, 0.8f, 0.7f);
  shares.muscle = soft * thin * rising(depth_mm, 65, 55);
  shares.organ = kOrgan * (soft - shares.muscle);
  return shares;
}

std::array<Structure, kLabelValues> structures_of(const std::vector<std::string>& tissue_of, const TissueTable& table) {
  std::array<Structure, kLabelValues> structures{};
  for (std::size_t label = 1; label < std::min(tissue_of.size(), std::size_t(kLabelValues)); ++label)
    if (const auto known = table.labelled.find(tissue_of[label]); known != table.labelled.end())
      structures[label] = known->second.structure;
  return structures;
}

/// Shifts the voxels of each label that has a tissue so that their mean is 0. The sums are of integers, so they do not
/// depend on the order of threads.
void centre_labels(std::vector<std::int16_t>& cdb, const Volume<std::uint8_t>& labels,
                   const std::array<Structure, kLabelValues>& structure_of) {
  std::array<std::atomic<std::int64_t>, kLabelValues> sums{}, counts{};
  const tbb::blocked_range<std::size_t> all(0, cdb.size(), 1u << 18);
  tbb::parallel_for(all, [&](const auto& range) {
    std::array<std::int64_t, kLabelValues> sum{}, count{};
    for (std::size_t v = range.begin(); v != range.end(); ++v) {
      sum[labels.voxels[v]] += cdb[v];
      ++count[labels.voxels[v]];
    }
    for (std::size_t l = 0; l < kLabelValues; ++l) {
      sums[l] += sum[l];
      counts[l] += count[l];
    }
  });
  std::array<int, kLabelValues> shift{};
  for (std::size_t l = 1; l < kLabelValues; ++l)
    if (structure_of[l] != Structure::none && counts[l] > 0)
      shift[l] = int(std::lround(double(sums[l]) / double(counts[l])));
  constexpr int kMost = int(kMostStructureDb * 100);
  tbb::parallel_for(all, [&](const auto& range) {
    for (std::size_t v = range.begin(); v != range.end(); ++v)
      cdb[v] = std::int16_t(std::clamp(cdb[v] - shift[labels.voxels[v]], -kMost, kMost));
  });
}

}  // namespace

std::vector<std::int16_t> tissue_structure_cdb(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                                               const std::vector<std::string>& tissue_of, const TissueTable& table,
                                               std::uint32_t seed) {
  std::vector<std::int16_t> cdb(ct.voxels.size());
  const Grid& grid = ct.grid;
  const double largest_mm = std::max({grid.spacing.x, grid.spacing.y, grid.spacing.z});
  if (ct.empty() || largest_mm > kLargestStructuredVoxel_mm) return cdb;

  const Surroundings surroundings(ct);
  const Formulas formulas(seed, float(largest_mm));
  const std::array<Structure, kLabelValues> structure_of = structures_of(tissue_of, table);
  const bool has_medulla =
      std::find(structure_of.begin(), structure_of.end(), Structure::medulla) != structure_of.end();
  std::array<std::optional<Pyramids>, kLabelValues> pyramids;
  if (!labels.empty() && !has_medulla)
    for (int l = 1; l < kLabelValues; ++l)
      if (structure_of[std::size_t(l)] == Structure::kidney) {
        Pyramids found(labels, l, structure_of);
        if (found.exist()) pyramids[std::size_t(l)] = std::move(found);
      }

  std::array<std::optional<SinusRim>, kLabelValues> rims;
  if (!labels.empty())
    for (int l = 1; l < kLabelValues; ++l)
      if (structure_of[std::size_t(l)] == Structure::sinus) rims[std::size_t(l)].emplace(labels, l, structure_of);

  const std::size_t in_slice = std::size_t(grid.size.x) * std::size_t(grid.size.y);
  const auto fill_slice = [&](int z) {
    std::array<Places, kStructures> places;
    Places with_pyramids, with_rim;
    const std::size_t first = std::size_t(z) * in_slice;
    for (std::size_t n = 0; n < in_slice; ++n) {
      const glm::ivec3 i(int(n % std::size_t(grid.size.x)), int(n / std::size_t(grid.size.x)), z);
      const int hu = ct.voxels[first + n];
      const std::uint8_t label = labels.empty() ? 0 : labels.voxels[first + n];
      const bool has_tissue = label < tissue_of.size() && !tissue_of[label].empty();
      if (has_tissue ? structure_of[label] == Structure::none : hu <= -150 || hu >= 130) continue;
      const glm::vec3 p(grid.patient_from_index(glm::dvec3(i)));
      const float depth = surroundings.depth_mm(i);
      if (has_tissue && pyramids[label]) {
        const Pyramids::Place place = pyramids[label]->at(i);
        with_pyramids.add(n, p, depth, 1);
        with_pyramids.u.push_back(float(place.nearest_mm.x));
        with_pyramids.v.push_back(float(place.nearest_mm.y));
        with_pyramids.w.push_back(float(place.nearest_mm.z));
        with_pyramids.outwards.push_back(place.outwards);
      } else if (has_tissue && rims[label]) {
        with_rim.add(n, p, depth, 1);
        with_rim.from_parenchyma.push_back(rims[label]->distance_mm(i));
      } else if (has_tissue) {
        places[std::size_t(structure_of[label])].add(n, p, depth, 1);
      } else {
        const Shares shares = shares_of(float(hu), depth, surroundings.soft_share(i), !labels.empty());
        const auto add = [&](Structure structure, float weight) {
          if (weight > 0) places[std::size_t(structure)].add(n, p, depth, weight);
        };
        add(Structure::fat, shares.fat);
        add(Structure::muscle, shares.muscle);
        add(Structure::organ, shares.organ);
      }
    }
    std::vector<float> db(in_slice);
    const auto add_all = [&](Structure structure, const Places& at) {
      const std::vector<float> values = formulas.at(structure, at);
      const float mean = formulas.mean(structure);
      for (std::size_t n = 0; n < values.size(); ++n) db[at.voxel[n]] += at.weight[n] * (values[n] - mean);
    };
    for (int s = 0; s < kStructures; ++s) add_all(Structure(s), places[std::size_t(s)]);
    add_all(Structure::kidney, with_pyramids);
    add_all(Structure::sinus, with_rim);
    constexpr float kMost = float(kMostStructureDb);
    for (std::size_t n = 0; n < in_slice; ++n)
      cdb[first + n] = std::int16_t(std::lround(100 * std::clamp(db[n], -kMost, kMost)));
  };
  tbb::parallel_for(tbb::blocked_range<int>(0, grid.size.z), [&](const auto& slices) {
    for (int z = slices.begin(); z != slices.end(); ++z) fill_slice(z);
  });
  if (!labels.empty()) centre_labels(cdb, labels, structure_of);
  return cdb;
}

}  // namespace insonate
