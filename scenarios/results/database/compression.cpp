#include "scenarios/results/database/compression.h"

#include <zlib.h>

#include <stdexcept>

namespace insonate {

std::string compressed(std::string_view bytes) {
  uLongf size = compressBound(uLong(bytes.size()));
  std::string zlib(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(zlib.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
               uLong(bytes.size())) != Z_OK)
    throw std::runtime_error("zlib does not compress");
  zlib.resize(size);
  return zlib;
}

std::optional<std::string> decompressed(std::string_view zlib, std::size_t size) {
  std::string bytes(size, '\0');
  uLongf got = uLongf(size);
  uLong taken = uLong(zlib.size());
  const int outcome =
      uncompress2(reinterpret_cast<Bytef*>(bytes.data()), &got, reinterpret_cast<const Bytef*>(zlib.data()), &taken);
  if (outcome != Z_OK || got != size || taken != zlib.size()) return std::nullopt;
  return bytes;
}

}  // namespace insonate
