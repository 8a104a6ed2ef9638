#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "sim/image_headers/element_type.h"
#include "sim/image_headers/header_text.h"

namespace insonate {

/// Returns whether the bytes begin like an NRRD file.
bool is_nrrd(std::string_view bytes);

/// Calls `field` for every line `name: value` of an NRRD header and `key` for every line `name:=value`. A key is
/// independent of the field with the same name. Skips comments. Returns where the data begins: after the empty line
/// that ends the header. A header that names a data file may also end with the bytes. Throws InputError if the bytes
/// are not such a header, or end within it.
/// @param file        the file's name in error messages
/// @param right_file  what to do about a file that is not NRRD
std::size_t read_nrrd_header(std::string_view bytes, const std::string& file, const std::string& right_file,
                             const TakeField& field, const TakeField& key);

/// Returns whether `name` is the field that names a separate data file.
bool is_nrrd_data_file(std::string_view name);

/// Returns the type that a field `type` names, or nothing.
std::optional<ElementType> nrrd_type(std::string_view name);

}  // namespace insonate
