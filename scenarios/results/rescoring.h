#pragma once

#include <string>

#include "scenarios/result.h"

namespace insonate {

/// Returns a sentence on how an attempt's stored score (Attempt::score_json) differs from a score computed now from the
/// same log. It names other versions and cases, and the first differing value. Returns an empty text if the scores are
/// identical to the bit. The program's version, the attempt's mode and the origin of the log (name, digest, transform)
/// are not compared. Throws InputError naming `name` if the score cannot be read or has an unknown format.
std::string why_different(const std::string& score_json, ExamResult now, const std::string& name);

}  // namespace insonate
