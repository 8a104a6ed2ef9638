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

/// Reads a file of any size through once and keeps its header. Refuses a header of more than `most_header` bytes. A
/// shorter file whose header does not end is kept as a whole. Throws InputError as read_file() does.
SequenceFile read_sequence_file(const std::filesystem::path& file, std::size_t most_header = std::size_t(1) << 30);

}  // namespace insonate
