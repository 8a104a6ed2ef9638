#include "sim/core/digest.h"

#include <xxhash.h>

#include <cinttypes>
#include <cstdio>

namespace insonate {

std::string digest_of(std::string_view bytes) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, std::uint64_t(XXH3_64bits(bytes.data(), bytes.size())));
  return text;
}

}  // namespace insonate
