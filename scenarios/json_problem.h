#pragma once

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

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

}  // namespace insonate
