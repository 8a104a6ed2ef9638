#pragma once

#include <string>
#include <string_view>

namespace insonate {

/// Passes the bytes to the reader of sequence files, whole and with their images left out. The reader promises, for any
/// bytes, an InputError or samples with rising times and rigid poses that a recording returns bit-exact. Returns an
/// empty string if it keeps that, otherwise what is broken. Other exceptions pass through.
std::string broken_sequence_promise(std::string_view bytes);

}  // namespace insonate
