#include "sim/tissue/tissue_structure.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "sim/tissue/structure/kidney_places.h"
#include "sim/tissue/structure/structure_formulas.h"
#include "sim/tissue/structure/surroundings.h"

namespace insonate {
namespace {

float rising(float x, float from, float to) {
  return std::clamp((x - from) / (to - from), 0.0f, 1.0f);
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

StructureOfLabel structures_of(const std::vector<std::string>& tissue_of, const TissueTable& table) {
  StructureOfLabel structures{};
  for (std::size_t label = 1; label < std::min(tissue_of.size(), std::size_t(kLabelValues)); ++label)
    if (const auto known = table.labelled.find(tissue_of[label]); known != table.labelled.end())
      structures[label] = known->second.structure;
  return structures;
}

/// Shifts the voxels of each label that has a tissue so that their mean is 0. The sums are of integers, so they do not
/// depend on the order of threads.
void centre_labels(std::vector<std::int16_t>& cdb, const Volume<std::uint8_t>& labels,
                   const StructureOfLabel& structure_of) {
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
  constexpr int kMax = int(kMaxStructure_db * 100);
  tbb::parallel_for(all, [&](const auto& range) {
    for (std::size_t v = range.begin(); v != range.end(); ++v)
      cdb[v] = std::int16_t(std::clamp(cdb[v] - shift[labels.voxels[v]], -kMax, kMax));
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
  const StructureFormulas formulas(seed, float(largest_mm));
  const StructureOfLabel structure_of = structures_of(tissue_of, table);
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
    std::array<StructurePlaces, kStructures> places;
    StructurePlaces with_pyramids, with_rim;
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
    const auto add_all = [&](Structure structure, const StructurePlaces& at) {
      const std::vector<float> values = formulas.at(structure, at);
      const float mean = formulas.mean(structure);
      for (std::size_t n = 0; n < values.size(); ++n) db[at.voxel[n]] += at.weight[n] * (values[n] - mean);
    };
    for (std::size_t s = 0; s < kStructures; ++s) add_all(Structure(s), places[s]);
    add_all(Structure::kidney, with_pyramids);
    add_all(Structure::sinus, with_rim);
    constexpr float kMax = float(kMaxStructure_db);
    for (std::size_t n = 0; n < in_slice; ++n)
      cdb[first + n] = std::int16_t(std::lround(100 * std::clamp(db[n], -kMax, kMax)));
  };
  tbb::parallel_for(tbb::blocked_range<int>(0, grid.size.z), [&](const auto& slices) {
    for (int z = slices.begin(); z != slices.end(); ++z) fill_slice(z);
  });
  if (!labels.empty()) centre_labels(cdb, labels, structure_of);
  return cdb;
}

}  // namespace insonate
