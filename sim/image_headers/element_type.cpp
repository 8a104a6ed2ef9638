#include "sim/image_headers/element_type.h"

namespace insonate {

std::string to_string(ElementType type) {
  static const char* const names[] = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                      "uint32", "int64", "uint64", "float32", "float64"};
  return names[std::size_t(type)];
}

std::size_t bytes_of(ElementType type) {
  return with_type(type, [](auto number) { return sizeof number; });
}

}  // namespace insonate
