#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace insonate {

/// Reads a part of a file from front to back, and unpacks it if it is packed. Memory does not depend on the file.
class ByteStream {
public:
  /// Throws InputError if the file cannot be opened.
  ByteStream(const std::filesystem::path& file, std::uint64_t offset, bool packed);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Reads up to `size` bytes, at most 4 GiB. Returns how many; less than `size` only at the end.
  std::size_t read(char* to, std::size_t size);
  /// Returns whether the packed stream was found to be damaged or cut off.
  bool is_damaged() const { return damaged_; }

private:
  std::size_t unpack(char* to, std::size_t size);

  std::ifstream stream_;
  bool packed_;
  bool damaged_ = false;
  bool at_stream_end_ = false;  ///< of one of several gzip streams in a row
  z_stream unpacker_{};
  std::vector<char> input_;
};

}  // namespace insonate
