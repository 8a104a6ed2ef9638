#pragma once

#include <string>
#include <string_view>

#include "devices/sequence/cut_bytes.h"
#include "devices/sequence/sequence_layout.h"

namespace insonate {

/// Returns whether nrrd_layout() reads a field.
bool is_nrrd_layout_field(std::string_view name);

/// Does what metaimage_layout() does, for raw and gzip encoding. `data` is what follows the header. For compressed
/// images it compares the size stored at the end of the gzip stream with the header's.
SequenceLayout nrrd_layout(const HeaderFields& fields, const CutBytes& data, const std::string& file);

}  // namespace insonate
