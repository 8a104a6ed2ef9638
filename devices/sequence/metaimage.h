#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "devices/sequence/header_text.h"
#include "devices/sequence/sequence_layout.h"

namespace insonate {

/// Calls `field` for every line `name = value` of a MetaImage header, with the line's number from 1 on. Returns where
/// the image data begins: after the line 'ElementDataFile = LOCAL', which ends the header. Lines end in LF or CR LF;
/// the last one may end with the file. Throws InputError if the bytes are not such a header or end within it.
std::size_t read_metaimage_header(
    std::string_view bytes, const std::string& file,
    const std::function<void(std::string_view name, std::string_view value, std::size_t line)>& field);

/// Returns whether metaimage_layout() reads a field. Only the writer knows what the other fields mean.
bool is_layout_field(std::string_view name);

/// Reads the layout of a MetaImage from the header's fields. It has 2 or 3 dimensions of an image and one of frames.
/// Checks that the image data is present in the `bytes_after` bytes after the header. Throws InputError if it is not,
/// or if the fields are malformed or contradict each other.
SequenceLayout metaimage_layout(const HeaderFields& fields, std::uint64_t bytes_after, const std::string& file);

}  // namespace insonate
