#pragma once

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "sim/core/image.h"

/// Bounds that the extreme pictures of both models must keep.
namespace insonate::test {

template <typename Real>
std::string at(const char* what, const Image<Real>& image, std::size_t i) {
  char text[120];
  std::snprintf(text, sizeof text, "%s is %.9g at (%d, %d)", what, double(image.pixels[i]),
                int(i % std::size_t(image.width)), int(i / std::size_t(image.width)));
  return text;
}

/// Returns a description of the first value that is not finite or lies outside [0, most].
template <typename Real>
std::optional<std::string> outside(const char* what, const Image<Real>& image, double most) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (!(image.pixels[i] >= 0 && double(image.pixels[i]) <= most)) return at(what, image, i);
  return std::nullopt;
}

inline long from_environment(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text ? std::strtol(text, nullptr, 10) : otherwise;
}

}  // namespace insonate::test
