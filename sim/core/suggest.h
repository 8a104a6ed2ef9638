#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// Returns the remedy for an unknown name, made to end an InputError: "did you mean 'hepatorenal'?" if a known name is
/// within a few typing slips of it, else "use one of 'a', 'b', 'c'".
std::string suggest(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace insonate
