#pragma once

#include <filesystem>
#include <string>

#include "devices/sequence/cut_bytes.h"

namespace insonate {

/// What there is to know of a sequence file without its images.
struct SequenceFile {
  std::string front, back;  ///< the header and a little more; the last bytes
  std::uint64_t size = 0;
  std::string digest;  ///< of all bytes (sim/core/digest.h)

  CutBytes bytes() const { return {front, size, back}; }
};

/// Reads a file of any size through once and keeps its header, which has 1 GiB at most; a file that has no header's end
/// is kept up to there. Throws InputError as read_file() does.
SequenceFile read_sequence_file(const std::filesystem::path& file);

}  // namespace insonate
