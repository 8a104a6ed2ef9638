#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "devices/sequence/header_text.h"
#include "devices/sequence/sequence_layout.h"

namespace insonate {

/// Calls `field` for every line `name = value` of a MetaImage header, with the line's number from 1 on, and returns
/// where the image data begins: after the line 'ElementDataFile = LOCAL', which ends the header. Lines end in LF or
/// CR LF, the last one perhaps in nothing. Throws InputError when the bytes are no such header or end within it.
std::size_t read_metaimage_header(
    std::string_view bytes, const std::string& file,
    const std::function<void(std::string_view name, std::string_view value, std::size_t line)>& field);

/// Whether metaimage_layout() looks at a field; of all others only the writer knows what they mean.
bool is_layout_field(std::string_view name);

/// Reads the layout of a MetaImage, whose dimensions are 2 or 3 of an image and one of frames, from the header's fields
/// and checks that the image data, `bytes_after` bytes at most, is there. Throws InputError when it is not, or when the
/// fields are malformed or contradict each other.
SequenceLayout metaimage_layout(const HeaderFields& fields, std::uint64_t bytes_after, const std::string& file);

}  // namespace insonate
