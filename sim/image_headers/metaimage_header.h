#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "sim/image_headers/element_type.h"
#include "sim/image_headers/header_text.h"

namespace insonate {

/// Calls `field` for every line `name = value` of a MetaImage header. Returns where the data begins: after the line
/// `ElementDataFile = ...`, which ends the header and is passed to `field` too. Skips empty lines. Throws InputError if
/// the bytes are not such a header, or end within it.
/// @param file        the file's name in error messages
/// @param right_file  what to do about a file that is not MetaImage
std::size_t read_metaimage_header(std::string_view bytes, const std::string& file, const std::string& right_file,
                                  const TakeField& field);

/// Returns the value of a field that is True or False. Throws InputError for any other value.
bool metaimage_flag(const std::string& file, std::string_view name, std::string_view value);

/// Returns the type that a field `ElementType` names, or nothing for one that is not a number.
std::optional<ElementType> metaimage_type(std::string_view name);

}  // namespace insonate
