#pragma once

#include <string>
#include <string_view>

namespace insonate {

/// Names a content by 16 hexadecimal digits, to tell later whether two scores come from the same inputs. It finds
/// accidents and old versions; it does not stand against someone who wants a collision (XXH3, 64 bits).
std::string digest_of(std::string_view bytes);

}  // namespace insonate
