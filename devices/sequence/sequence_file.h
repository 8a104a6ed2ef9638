#pragma once

#include <filesystem>
#include <string>

#include "devices/sequence/cut_bytes.h"

namespace insonate {

/// A sequence file without its images.
struct SequenceFile {
  std::string front, back;  ///< the header and some bytes more; the last bytes
  std::uint64_t size = 0;
  std::string digest;  ///< digest of all bytes (sim/files/digest.h)

  CutBytes bytes() const { return {front, size, back}; }
};

/// Reads a file of any size once from start to end, and stores its header. Refuses a header of more than `most_header`
/// bytes. A shorter file whose header does not end is stored completely. Throws InputError as read_file() does.
SequenceFile read_sequence_file(const std::filesystem::path& file, std::size_t most_header = std::size_t(1) << 30);

}  // namespace insonate
