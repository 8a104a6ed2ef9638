#pragma once

#include <string>
#include <string_view>

#include "scenarios/result.h"

namespace insonate {

/// Returns a result as JSON for programs; people read the report. It has `"format": 2`, keys that include their units,
/// and numbers with enough digits to restore the same double.
std::string to_json(const ExamResult& result);

/// Parses the output of to_json(). Throws InputError naming `name` if the text is not such JSON.
ExamResult result_from_json(std::string_view text, const std::string& name);

}  // namespace insonate
