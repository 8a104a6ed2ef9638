#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/structure_shape.h"

namespace insonate {

/// Checks labels against anatomy and against their CT. Right structures lie to the right of left ones, vertebrae lie in
/// their order, and front organs lie before the spine. Lungs, soft organs and bones have plausible densities. Returns
/// notes, one sentence each, for deviations of single structures. Throws InputError naming `file` if the labels are
/// mirrored, rotated or from another scan.
std::vector<std::string> check_plausible(const std::string& file, const Case& subject,
                                         const std::vector<StructureShape>& shapes);

}  // namespace insonate
