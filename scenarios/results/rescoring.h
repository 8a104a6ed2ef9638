#pragma once

#include <string>

#include "scenarios/result.h"

namespace insonate {

/// How an attempt's score (Attempt::score_json) differs from one made from the same log now, in a sentence: versions
/// and cases that are others, and the first value that came out otherwise. Empty when they are the same to the bit;
/// the program's version, the attempt's mode, and where the log was read from, do not count. Throws InputError naming
/// `name` when the score is none, or of a format that this program does not read.
std::string why_different(const std::string& score_json, ExamResult now, const std::string& name);

}  // namespace insonate
