#pragma once

#include <string>
#include <string_view>

namespace insonate {

/// Who took an exam, as an opaque id: 1 to 64 letters of ASCII, digits, '.', '_' and '-'. Names and mail addresses do
/// not pass, or at least not as people write them; the list of who is who stays with the lab.

/// What is wrong with an id, as the problem part of an InputError; empty when nothing is.
std::string why_no_learner_id(std::string_view id);

/// Throws InputError when there is something wrong with it. `place` says where the id stands: "--learner".
void check_learner_id(std::string_view id, const std::string& file, const std::string& place);

/// Of attempts when nobody said whose they are.
inline constexpr const char* kNobodyInParticular = "anonymous";

}  // namespace insonate
