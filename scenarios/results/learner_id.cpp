#include "scenarios/results/learner_id.h"

#include <algorithm>

#include "sim/core/input_error.h"

namespace insonate {

std::string why_no_learner_id(std::string_view id) {
  constexpr std::size_t kLongest = 64;
  constexpr std::string_view kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  if (id.empty()) return "the learner's id is empty";
  if (id.size() > kLongest)
    return "the learner's id has " + std::to_string(id.size()) + " characters, above the limit of " +
           std::to_string(kLongest);
  if (id.find_first_not_of(kAllowed) != std::string_view::npos) {
    std::string shown(id);
    const bool has_space = id.find(' ') != std::string_view::npos;
    // Bytes outside printable ASCII would not display correctly, and the id may come from any file.
    std::replace_if(
        shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
    return "'" + shown + "' is not an id: " + (has_space ? "it has a space; " : "") +
           "only letters A to Z and a to z, digits, '.', '_' and '-' can stand in one";
  }
  return {};
}

void check_learner_id(std::string_view id, const std::string& file, const std::string& place) {
  if (const std::string why = why_no_learner_id(id); !why.empty())
    throw InputError(file, place, why, "use a code from which only your lab knows the person");
}

}  // namespace insonate
