#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// The remedy for a name that nobody knows: "did you mean 'hepatorenal'?" when a known name is within a few typing
/// slips of it, else "use one of 'a', 'b', 'c'". Made to end an InputError.
std::string suggest(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace insonate
