#pragma once

#include <string>
#include <string_view>

namespace insonate {

/// Gives the bytes to the reader of sequence files, whole and with their images left out. Empty when it keeps what it
/// promises of any bytes: an InputError, or samples with rising times and rigid poses that a recording gives back to
/// the bit; else what is broken. Other exceptions pass.
std::string broken_sequence_promise(std::string_view bytes);

}  // namespace insonate
