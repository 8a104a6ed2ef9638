#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "tests/tools/render/vec3.h"

namespace outsider {

/// A body made of formulas: skin at y = 0 (patient mm, LPS), fat, parenchyma with grain, a cyst and a rib. It has no
/// gas, because at a gas surface single precision alone decides what is visible. It lies on a rotated grid of 1 mm
/// voxels, so that readers do not resample the values.
struct SyntheticCt {
  std::array<int, 3> size{150, 112, 48};
  std::array<Vec3, 3> axes{{{0.96, 0.28, 0}, {-0.28, 0.96, 0}, {0, 0, -1}}};
  Vec3 origin;
  std::vector<std::int16_t> voxels;  ///< Hounsfield units, first axis fastest

  SyntheticCt();
  void write_nrrd(const std::filesystem::path& file) const;
};

}  // namespace outsider
