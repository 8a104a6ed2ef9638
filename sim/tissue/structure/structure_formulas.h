#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/tissue/tissue.h"

namespace insonate {

inline constexpr std::size_t kStructures = std::size_t(Structure::sinus) + 1;

/// Places of one structure, as the formulas read them: a list per quantity.
struct StructurePlaces {
  std::vector<std::size_t> voxel;             ///< in the slice
  std::vector<float> x, y, z, depth, weight;  ///< patient mm; the structure's share
  std::vector<float> u, v, w, outwards;       ///< of kidneys alone: Pyramids::Place
  std::vector<float> from_parenchyma;         ///< of a sinus beside a kidney alone, mm

  std::size_t size() const { return x.size(); }
  /// @param at  in the slice
  void add(std::size_t at, const glm::vec3& p, float depth_mm, float share_of) {
    voxel.push_back(at);
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
    depth.push_back(depth_mm);
    weight.push_back(share_of);
  }
};

/// Evaluates the formulas of tissue_structure.h, without their mean.
class StructureFormulas {
public:
  /// @param voxel_mm  largest side of a voxel: sheets and lines are no thinner than it can hold
  StructureFormulas(std::uint32_t seed, float voxel_mm);

  /// Returns the mean of a structure's formula, dB.
  float mean(Structure structure) const { return means_[std::size_t(structure)]; }
  /// Returns the formula at each place, dB.
  std::vector<float> at(Structure structure, const StructurePlaces& places) const;

private:
  float mean_of(Structure structure) const;

  std::uint32_t seed_;
  float widened_;  // factor on the thickness of sheets and lines
  std::array<float, kStructures> means_{};
};

}  // namespace insonate
