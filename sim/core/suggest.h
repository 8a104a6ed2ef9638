#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// Returns the known name that is within a few typing slips of an unknown one and nearest to it, if there is one.
std::optional<std::string> similar_name(std::string_view unknown, const std::vector<std::string>& known);

/// Returns the remedy for an unknown name, made to end an InputError: "did you mean 'hepatorenal'?" if a known name is
/// within a few typing slips of it, else "use one of 'a', 'b', 'c'".
std::string suggest(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace insonate
