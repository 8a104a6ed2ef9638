#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "devices/sequence/sequence_layout.h"

namespace insonate {

/// Returns whether metaimage_layout() reads a field. Only the writer knows what the other fields mean.
bool is_layout_field(std::string_view name);

/// Reads the layout of a MetaImage from the header's fields. It has 2 or 3 dimensions of an image and one of frames.
/// Checks that the image data is present in the `bytes_after` bytes after the header. Throws InputError if it is not,
/// or if the fields are malformed or contradict each other.
SequenceLayout metaimage_layout(const HeaderFields& fields, std::uint64_t bytes_after, const std::string& file);

}  // namespace insonate
