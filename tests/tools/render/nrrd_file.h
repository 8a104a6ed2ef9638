#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/core/grid.h"
#include "sim/core/image.h"

namespace insonate::test {

/// A type's name in the headers that the project writes.
template <typename T>
inline constexpr const char* kTypeName = nullptr;
template <>
inline constexpr const char* kTypeName<float> = "float";
template <>
inline constexpr const char* kTypeName<std::int16_t> = "short";
template <>
inline constexpr const char* kTypeName<std::uint8_t> = "unsigned char";

/// An NRRD file, read without the project's own reader: raw little-endian values behind a text header.
struct NrrdFile {
  std::map<std::string, std::string> fields;  ///< the header's, by name
  std::string bytes;                          ///< of the values

  /// Throws std::runtime_error if the file is not a raw little-endian NRRD.
  explicit NrrdFile(const std::filesystem::path& file);

  /// Returns the header's sizes, the fastest axis first.
  std::vector<int> sizes() const;

  /// Throws std::runtime_error if the values are of another type, or more or fewer than the sizes.
  template <typename T>
  std::vector<T> values() const {
    if (fields.at("type") != kTypeName<T>) throw std::runtime_error("the values are of another type");
    std::size_t count = 1;
    for (const int size : sizes()) count *= std::size_t(size);
    if (bytes.size() != count * sizeof(T)) throw std::runtime_error("the values do not fit the sizes");
    std::vector<T> all(count);
    std::memcpy(all.data(), bytes.data(), bytes.size());
    return all;
  }

  /// Returns a file of two axes. Throws std::runtime_error if it is another.
  Image<float> image() const;

  /// Returns the grid of a volume in the patient's frame (LPS). Throws std::runtime_error if it is not one.
  Grid grid() const;

  template <typename T>
  Volume<T> volume() const {
    return {grid(), values<T>()};
  }
};

}  // namespace insonate::test
