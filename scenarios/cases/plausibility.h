#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/structure_shape.h"

namespace insonate {

/// Holds labels against anatomy and against the CT they lie on: right is right of left, vertebrae lie in their order,
/// front organs before the spine, and lungs, soft organs and bones are about as dense as they should be. What only a
/// single structure breaks comes back as notes, a sentence each. Throws InputError, naming `file`, when the labels are
/// mirrored, turned, or another scan's.
std::vector<std::string> check_plausible(const std::string& file, const Case& subject,
                                         const std::vector<StructureShape>& shapes);

}  // namespace insonate
