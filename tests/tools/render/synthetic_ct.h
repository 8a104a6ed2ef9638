#pragma once

#include <cstdint>

#include "sim/core/grid.h"

namespace insonate::test {

/// Returns a body made of formulas: skin at y = 0 (patient mm, LPS), fat, parenchyma with grain, a cyst and a rib. It
/// has no gas, because at a gas surface single precision alone decides what is visible. It lies on a rotated grid of 1
/// mm voxels, so that readers do not resample the values.
Volume<std::int16_t> synthetic_ct();

}  // namespace insonate::test
