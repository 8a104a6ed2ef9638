#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "devices/sequence/cut_bytes.h"
#include "devices/sequence/header_text.h"
#include "devices/sequence/sequence_layout.h"

namespace insonate {

/// Whether the bytes begin as a NRRD file does.
bool is_nrrd(std::string_view bytes);

using HeaderLine = std::function<void(std::string_view name, std::string_view value, std::size_t line)>;

/// Calls `field` for every line `name: value` of a NRRD header and `key` for every line `name:=value`, with the line's
/// number from 1 on, and returns where the image data begins: after the empty line that ends the header. A key says
/// nothing of the field that is called the same. Comments are skipped. Throws InputError when the bytes are no such
/// header, when it ends within, or when its data lie in another file.
std::size_t read_nrrd_header(std::string_view bytes, const std::string& file, const HeaderLine& field,
                             const HeaderLine& key);

/// Whether nrrd_layout() looks at a field.
bool is_nrrd_layout_field(std::string_view name);

/// As metaimage_layout(), of raw and gzip encoding; `data` is what follows the header. Of compressed images the size
/// that gzip keeps at its end is held against the header's.
SequenceLayout nrrd_layout(const HeaderFields& fields, const CutBytes& data, const std::string& file);

}  // namespace insonate
