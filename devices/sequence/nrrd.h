#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "devices/sequence/cut_bytes.h"
#include "devices/sequence/header_text.h"
#include "devices/sequence/sequence_layout.h"

namespace insonate {

/// Returns whether the bytes begin like a NRRD file.
bool is_nrrd(std::string_view bytes);

using HeaderLine = std::function<void(std::string_view name, std::string_view value, std::size_t line)>;

/// Calls `field` for every line `name: value` of a NRRD header and `key` for every line `name:=value`, with the line's
/// number from 1 on. Returns where the image data begins: after the empty line that ends the header. A key is
/// independent of the field with the same name. Comments are skipped. Throws InputError if the bytes are not such a
/// header, if it is incomplete, or if its data is in another file.
std::size_t read_nrrd_header(std::string_view bytes, const std::string& file, const HeaderLine& field,
                             const HeaderLine& key);

/// Returns whether nrrd_layout() reads a field.
bool is_nrrd_layout_field(std::string_view name);

/// Does what metaimage_layout() does, for raw and gzip encoding. `data` is what follows the header. For compressed
/// images it compares the size stored at the end of the gzip stream with the header's.
SequenceLayout nrrd_layout(const HeaderFields& fields, const CutBytes& data, const std::string& file);

}  // namespace insonate
