#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace insonate {

/// Header fields by name, as they stand in the file's bytes.
using MetaImageFields = std::map<std::string_view, std::string_view>;

/// Calls `field` for every line `name = value` of a MetaImage header, with the line's number from 1 on, and returns
/// where the image data begins: after the line 'ElementDataFile = LOCAL', which ends the header. Lines end in LF or
/// CR LF, the last one perhaps in nothing. Throws InputError when the bytes are no such header or end within it.
std::size_t read_metaimage_header(
    std::string_view bytes, const std::string& file,
    const std::function<void(std::string_view name, std::string_view value, std::size_t line)>& field);

/// Whether metaimage_layout() looks at a field; of all others only the writer knows what they mean.
bool is_layout_field(std::string_view name);

/// The size of a MetaImage whose dimensions are 2 or 3 of an image and one of frames.
struct MetaImageLayout {
  std::uint64_t frames = 0;       ///< at least 1; only claimed, so nothing may be allocated by it alone
  bool has_images = false;        ///< false for transform-only files, whose images have no pixel or one
  std::uint64_t image_bytes = 0;  ///< of all frames, as stored; no more than there are
};

/// Reads the layout from the header's fields and checks that the image data, `bytes_after` bytes at most, is there.
/// Throws InputError when it is not, or when the fields are malformed or contradict each other.
MetaImageLayout metaimage_layout(const MetaImageFields& fields, std::uint64_t bytes_after, const std::string& file);

}  // namespace insonate
