#include "sim/volume/byte_stream.h"

#include <new>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr std::size_t kInputBytes = 1u << 16;

}  // namespace

ByteStream::ByteStream(const std::filesystem::path& file, std::uint64_t offset, bool packed)
    : stream_(file, std::ios::binary), packed_(packed) {
  if (!stream_.seekg(std::streamoff(offset)))
    throw InputError(file.string(), "header", "it cannot be read", "check its permissions");
  constexpr int kZlibOrGzip = 15 + 32;
  if (packed_ && inflateInit2(&unpacker_, kZlibOrGzip) != Z_OK) throw std::bad_alloc();
}

ByteStream::~ByteStream() {
  if (packed_) inflateEnd(&unpacker_);
}

std::size_t ByteStream::read(char* to, std::size_t size) {
  if (packed_) return unpack(to, size);
  stream_.read(to, std::streamsize(size));
  return std::size_t(stream_.gcount());
}

std::size_t ByteStream::unpack(char* to, std::size_t size) {
  input_.resize(kInputBytes);
  unpacker_.next_out = reinterpret_cast<Bytef*>(to);
  unpacker_.avail_out = uInt(size);
  while (unpacker_.avail_out > 0 && !damaged_) {
    if (unpacker_.avail_in == 0) {
      stream_.read(input_.data(), std::streamsize(kInputBytes));
      unpacker_.next_in = reinterpret_cast<Bytef*>(input_.data());
      unpacker_.avail_in = uInt(stream_.gcount());
      if (unpacker_.avail_in == 0) {
        damaged_ = !at_stream_end_;
        break;
      }
    }
    if (at_stream_end_) inflateReset(&unpacker_);
    const int state = inflate(&unpacker_, Z_NO_FLUSH);
    at_stream_end_ = state == Z_STREAM_END;
    damaged_ = state != Z_OK && state != Z_STREAM_END;
  }
  return size - unpacker_.avail_out;
}

}  // namespace insonate
