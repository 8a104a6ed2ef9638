#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "devices/sequence/header_text.h"
#include "devices/sequence/sequence_layout.h"

namespace insonate {

/// Whether the bytes begin as a NRRD file does.
bool is_nrrd(std::string_view bytes);

/// Calls `field` for every line `name: value` and `key:=value` of a NRRD header, with the line's number from 1 on, and
/// returns where the image data begins: after the empty line that ends the header. Comments are skipped. Throws
/// InputError when the bytes are no such header, when it ends within, or when its data lie in another file.
std::size_t read_nrrd_header(
    std::string_view bytes, const std::string& file,
    const std::function<void(std::string_view name, std::string_view value, std::size_t line)>& field);

/// Whether nrrd_layout() looks at a field.
bool is_nrrd_layout_field(std::string_view name);

/// As metaimage_layout(), of raw and gzip encoding; `data` is what follows the header. Of compressed images the size
/// that gzip keeps at its end is held against the header's.
SequenceLayout nrrd_layout(const HeaderFields& fields, std::string_view data, const std::string& file);

}  // namespace insonate
