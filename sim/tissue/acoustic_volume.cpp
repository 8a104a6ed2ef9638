#include "sim/tissue/acoustic_volume.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/files/digest.h"
#include "sim/tissue/ct_noise.h"
#include "sim/tissue/tissue_structure.h"

namespace insonate {
namespace {

std::int16_t centidecibel(double db) {
  return std::int16_t(std::lround(db * 100));
}

/// Returns the part of a difference that is texture, not partial volume, HU.
double texture_hu(double hu_above_mean) {
  const double away = std::abs(hu_above_mean);
  return hu_above_mean * std::clamp((kRim_hu - away) / (kRim_hu - kTexture_hu), 0.0, 1.0);
}

/// The slices at the head's and the feet's end in which sound is lost.
class Ends {
public:
  explicit Ends(const Grid& grid)
      : axis_(feet_head_axis(grid)), slices_(end_slices(grid)), last_(grid.size[axis_] - 1) {}
  bool contain(const glm::ivec3& i) const { return distance(i) < slices_; }
  double echogenicity_db(const glm::ivec3& i) const {
    return kMinEchogenicity_db + double(slices_ - distance(i)) / slices_ * (kEnd_db - kMinEchogenicity_db);
  }

private:
  int distance(const glm::ivec3& i) const { return std::min(i[axis_], last_ - i[axis_]); }

  int axis_ = 0, slices_ = 0, last_ = 0;
};

/// Returns the echogenicity by density alone, for each int16 value of HU.
std::vector<std::int16_t> tabulate(const TissueTable& table) {
  std::vector<std::int16_t> by_hu(1u << 16);
  for (int hu = -32768; hu <= 32767; ++hu) by_hu[std::size_t(hu + 32768)] = centidecibel(table.at(hu).echogenicity_db);
  return by_hu;
}

/// Returns the mean density per label value. The sums are of integers, so they do not depend on the order of threads.
std::array<double, kLabelValues> mean_densities(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels) {
  std::array<std::atomic<std::int64_t>, kLabelValues> sums{}, counts{};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ct.voxels.size(), 1u << 18), [&](const auto& range) {
    std::array<std::int64_t, kLabelValues> sum{}, count{};
    for (std::size_t v = range.begin(); v != range.end(); ++v) {
      sum[labels.voxels[v]] += ct.voxels[v];
      ++count[labels.voxels[v]];
    }
    for (int l = 0; l < kLabelValues; ++l)
      if (count[std::size_t(l)]) {
        sums[std::size_t(l)] += sum[std::size_t(l)];
        counts[std::size_t(l)] += count[std::size_t(l)];
      }
  });
  std::array<double, kLabelValues> means{};
  for (std::size_t l = 0; l < kLabelValues; ++l) means[l] = counts[l] ? double(sums[l]) / double(counts[l]) : 0;
  return means;
}

class VoxelOf {
public:
  VoxelOf(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels, const std::vector<std::string>& tissue_of,
          const TissueTable& table)
      : ct_(ct), labels_(labels), ends_(ct.grid), by_hu_(tabulate(table)), densest_air_(table.densest_air_hu()) {
    for (int axis = 0; axis < 3; ++axis)
      reach_[axis] = std::max(1, int(std::lround(kEdgeRadius_mm / ct.grid.spacing[axis])));
    if (labels.empty()) return;
    means_ = mean_densities(ct, labels);
    for (std::size_t l = 1; l < tissue_of.size(); ++l) {
      if (tissue_of[l].empty()) continue;
      const auto known = table.labelled.find(tissue_of[l]);
      if (known == table.labelled.end()) {
        std::vector<std::string> names;
        for (const auto& [name, tissue] : table.labelled) names.push_back(name);
        throw InputError("label table", "label " + std::to_string(l), "the tissue '" + tissue_of[l] + "' is unknown",
                         suggest(tissue_of[l], names));
      }
      has_tissue_[l] = true;
      tissue_db_[l] = known->second.echogenicity_db;
    }
  }

  AcousticVoxel operator()(const glm::ivec3& i) const {
    const std::size_t v = ct_.grid.offset(i);
    const std::uint8_t label = labels_.empty() ? 0 : labels_.voxels[v];
    const int hu = ct_.voxels[v];
    const int noise_hu =
        has_tissue_[label] && tissue_db_[label] < kFluid_db ? int(std::lround(texture_hu(hu - means_[label]))) : 0;
    const bool is_end = hu > densest_air_ && ends_.contain(i);
    return {std::int16_t(hu - noise_hu),
            is_end ? centidecibel(ends_.echogenicity_db(i)) : echogenicity_cdb(i, label, hu)};
  }

private:
  std::int16_t echogenicity_cdb(const glm::ivec3& i, std::uint8_t label, int hu) const {
    if (has_tissue_[label])
      return centidecibel(std::clamp(tissue_db_[label] + kTextureDbPerHu * texture_hu(hu - means_[label]),
                                     kMinEchogenicity_db, kMaxEchogenicity_db));
    if (is_amid_air(i)) return centidecibel(kMinEchogenicity_db);
    std::int16_t echo = by_density(hu);
    std::ptrdiff_t stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const int reach = reach_[axis];
      if (i[axis] >= reach && i[axis] + reach < ct_.grid.size[axis]) {
        const std::int16_t* here = ct_.voxels.data() + ct_.grid.offset(i);
        const int before = here[-reach * stride], after = here[reach * stride];
        const auto [low, high] = std::minmax(before, after);
        if (hu - low >= kEdgeMargin_hu && high - hu >= kEdgeMargin_hu)
          echo = std::max({echo, by_density(before), by_density(after)});
      }
      if (labels_.empty() && by_density(hu) < centidecibel(kFluid_db))
        echo = std::max(echo, beside_layer(i, axis, stride));
      stride *= ct_.grid.size[axis];
    }
    return echo;
  }

  /// Returns the echogenicity beside a thin layer that holds the voxel, if there are a lighter and a denser tissue on
  /// its sides; else the least.
  std::int16_t beside_layer(const glm::ivec3& i, int axis, std::ptrdiff_t stride) const {
    const std::int16_t* here = ct_.voxels.data() + ct_.grid.offset(i);
    const int hu = *here, most = int(kLayer_mm / ct_.grid.spacing[axis]);  // voxels of a layer
    const auto steps_to_other = [&](int direction, int room) {
      int steps = 1;
      while (steps <= room && std::abs(here[direction * steps * stride] - hu) < kEdgeMargin_hu) ++steps;
      return steps <= room ? steps : 0;
    };
    const int below = steps_to_other(-1, std::min(most, i[axis]));
    if (!below) return centidecibel(kMinEchogenicity_db);
    const int above = steps_to_other(1, std::min(most + 1 - below, ct_.grid.size[axis] - 1 - i[axis]));
    if (!above) return centidecibel(kMinEchogenicity_db);
    const int before = here[-below * stride], after = here[above * stride];
    const auto [light, dense] = std::minmax(before, after);
    return light > kMaxAir_hu && light < hu && dense > hu ? std::max(by_density(before), by_density(after))
                                                          : centidecibel(kMinEchogenicity_db);
  }

  // Voxels beyond the grid count as air.
  bool is_amid_air(const glm::ivec3& i) const {
    if (ct_.at(i) > densest_air_) return false;
    const glm::ivec3 low = glm::max(i - 1, 0), high = glm::min(i + 1, ct_.grid.size - 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
          if (ct_.at({x, y, z}) > densest_air_) return false;
    return true;
  }

  std::int16_t by_density(int hu) const { return by_hu_[std::size_t(hu + 32768)]; }

  const Volume<std::int16_t>& ct_;
  const Volume<std::uint8_t>& labels_;
  Ends ends_;
  std::vector<std::int16_t> by_hu_;
  int densest_air_;
  glm::ivec3 reach_{1};
  std::array<double, kLabelValues> means_{};
  std::array<double, kLabelValues> tissue_db_{};
  std::array<bool, kLabelValues> has_tissue_{};
};

AcousticVolume acoustic_volume_of(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                                  const std::vector<std::string>& tissue_of, const TissueTable& table) {
  const VoxelOf voxel(ct, labels, tissue_of, table);
  AcousticVolume acoustic;
  acoustic.grid = ct.grid;
  acoustic.voxels.resize(ct.voxels.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, ct.grid.size.z), [&](const auto& slices) {
    for (int z = slices.begin(); z != slices.end(); ++z)
      for (int y = 0; y < ct.grid.size.y; ++y)
        for (int x = 0; x < ct.grid.size.x; ++x) {
          const glm::ivec3 i(x, y, z);
          acoustic.voxels[ct.grid.offset(i)] = voxel(i);
        }
  });
  return acoustic;
}

void add_structure(AcousticVolume& volume, const std::vector<std::int16_t>& structure_cdb) {
  static const int least = centidecibel(kMinEchogenicity_db), most = centidecibel(kMaxEchogenicity_db);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, volume.voxels.size(), 1u << 18), [&](const auto& range) {
    for (std::size_t v = range.begin(); v != range.end(); ++v) {
      std::int16_t& cdb = volume.voxels[v].echogenicity_cdb;
      if (cdb > least) cdb = std::int16_t(std::clamp(cdb + structure_cdb[v], least, most));
    }
  });
}

}  // namespace

int feet_head_axis(const Grid& grid) {
  int along = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (std::abs(grid.direction[axis].z) > std::abs(grid.direction[along].z)) along = axis;
  return along;
}

int end_slices(const Grid& grid) {
  const int axis = feet_head_axis(grid);
  const int slices = std::max(2, int(std::lround(kEnd_mm / grid.spacing[axis])));
  return grid.size[axis] < 4 * slices ? 0 : slices;
}

double to_end_mm(const Grid& grid, const glm::dvec3& point) {
  const int axis = feet_head_axis(grid);
  const double index = grid.index_from_patient(point)[axis];
  return grid.spacing[axis] * std::min(index, grid.size[axis] - 1 - index);
}

AcousticVolume make_acoustic_volume(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                                    const std::vector<std::string>& tissue_of, const TissueTable& table,
                                    bool structure) {
  if (!labels.empty() && labels.grid.size != ct.grid.size)
    throw std::invalid_argument("make_acoustic_volume: the labels are on another grid than the CT");
  if (tissue_of.size() > kLabelValues) throw std::invalid_argument("make_acoustic_volume: more than 256 label values");
  const auto made_of = [&](const Volume<std::int16_t>& densities) {
    AcousticVolume acoustic = acoustic_volume_of(densities, labels, tissue_of, table);
    if (structure) add_structure(acoustic, tissue_structure_cdb(densities, labels, tissue_of, table));
    return acoustic;
  };
  return labels.empty() ? made_of(without_noise(ct, ct_noise_hu(ct))) : made_of(ct);
}

std::string digest_of(const AcousticVolume& volume) {
  Digest digest;
  const auto add = [&](const void* data, std::size_t bytes) { digest.add({static_cast<const char*>(data), bytes}); };
  add(&volume.grid.size, sizeof volume.grid.size);
  add(&volume.grid.spacing, sizeof volume.grid.spacing);
  add(&volume.grid.origin, sizeof volume.grid.origin);
  add(&volume.grid.direction, sizeof volume.grid.direction);
  add(volume.voxels.data(), volume.voxels.size() * sizeof volume.voxels.front());
  return digest.text();
}

double scatterer_amplitude_at(const AcousticVolume& volume, const glm::dmat4& index_from_patient,
                              const glm::dvec3& patient_mm) {
  const glm::dvec3 index(index_from_patient * glm::dvec4(patient_mm, 1));
  if (glm::any(glm::lessThan(index, glm::dvec3(0))) ||
      glm::any(glm::greaterThan(index, glm::dvec3(volume.grid.size - 1))))
    return 0;
  const glm::ivec3 low(floor_of(index.x), floor_of(index.y), floor_of(index.z));
  const glm::dvec3 f = index - glm::dvec3(low);
  double db = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const double weight = (step.x ? f.x : 1 - f.x) * (step.y ? f.y : 1 - f.y) * (step.z ? f.z : 1 - f.z);
    if (weight > 0) db += weight * volume.at(low + step).echogenicity_cdb / 100.0;
  }
  return std::max(std::pow(10.0, db / 10) - std::pow(10.0, kSilent_db / 10), 0.0);
}

}  // namespace insonate
