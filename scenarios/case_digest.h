#pragma once

#include <string>

#include "sim/volume/case.h"

namespace insonate {

/// Returns the digest (sim/files/digest.h) of everything that scoring reads from a case: grid, CT, labels, their names,
/// landmarks and views.
std::string digest_of(const Case& subject);

}  // namespace insonate
