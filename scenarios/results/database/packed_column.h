#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "scenarios/results/database/compression.h"
#include "scenarios/results/database/sqlite.h"

namespace insonate {

/// Returns the decompressed bytes of two columns: the size before compression, and the compressed bytes. Returns
/// nothing if they are damaged.
inline std::optional<std::string> unpack(const sqlite::Statement& row, int size_column) {
  // Same limit as read_file() has for a log; a larger log is not valid.
  constexpr std::int64_t kLargest = std::int64_t(1) << 30;
  const std::int64_t size = row.integer(size_column);
  if (size < 0 || size > kLargest) return std::nullopt;
  return decompressed(row.bytes(size_column + 1), std::size_t(size));
}

}  // namespace insonate
