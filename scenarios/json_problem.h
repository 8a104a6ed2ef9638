#pragma once

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace insonate {

/// Returns what the JSON library found wrong with a text, in plain words, to follow a colon in an error sentence.
inline std::string json_problem(const nlohmann::json::exception& error, std::string_view text) {
  if (const auto* parsing = dynamic_cast<const nlohmann::json::parse_error*>(&error)) {
    const auto end = text.begin() + std::ptrdiff_t(std::min(parsing->byte, text.size()));
    return "line " + std::to_string(1 + std::count(text.begin(), end, '\n')) + " is not JSON";
  }
  // "[json.exception.out_of_range.403] key 'title' not found"
  const std::string what = error.what();
  const std::size_t own = what.find("] ");
  return own == std::string::npos ? what : what.substr(own + 2);
}

/// Reads a value. Throws what the JSON library throws, and std::runtime_error where a whole number is asked for and the
/// number is not one, or does not fit: the library would convert it, which is undefined.
template <typename Json, typename T>
void read_value(const Json& json, T& value) {
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    const bool fits = json.is_number_unsigned()  ? std::in_range<T>(json.template get<std::uint64_t>())
                      : json.is_number_integer() ? std::in_range<T>(json.template get<std::int64_t>())
                                                 : !json.is_number();
    if (!fits) throw std::runtime_error("a number that is not whole, or out of range: " + json.dump());
  }
  json.get_to(value);
}

}  // namespace insonate
