#pragma once

#include <string>

#include "sim/volume/case.h"

namespace insonate {

/// The digest (sim/core/digest.h) of all that scoring reads of a case: grid, CT, labels, their names, landmarks and
/// views.
std::string digest_of(const Case& subject);

}  // namespace insonate
