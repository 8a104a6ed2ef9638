#pragma once

#include <string>
#include <string_view>

#include "scenarios/result.h"

namespace insonate {

/// A result as JSON: `"format": 2`, keys spelled with their units, numbers with as many digits as bring back the same
/// double. Made for programs; people get the report.
std::string to_json(const ExamResult& result);

/// The way back. Throws InputError naming `name` when the text is no such JSON.
ExamResult result_from_json(std::string_view text, const std::string& name);

}  // namespace insonate
