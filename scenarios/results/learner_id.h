#pragma once

#include <string>
#include <string_view>

namespace insonate {

/// A learner's id is opaque: 1 to 64 ASCII letters, digits, '.', '_' and '-'. Names and mail addresses in their usual
/// form are refused. The lab keeps the list that assigns ids to people.

/// Returns what is wrong with an id, as the problem part of an InputError. Returns an empty text for a valid id.
std::string why_no_learner_id(std::string_view id);

/// Throws InputError if the id is not valid. `place` is where the id stands: "--learner".
void check_learner_id(std::string_view id, const std::string& file, const std::string& place);

/// The id of attempts without a named learner.
inline constexpr const char* kNobodyInParticular = "anonymous";

}  // namespace insonate
