#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace insonate {

/// Some of several images: `count` from `first` on, or as many as there are.
struct ImageRange {
  std::size_t first = 0, count = std::size_t(-1);

  bool operator==(const ImageRange&) const = default;

  /// Returns the range without what lies beyond the end of `images` images.
  ImageRange within(std::size_t images) const {
    const std::size_t begin = std::min(first, images);
    return {begin, std::min(count, images - begin)};
  }
  /// Returns the values of these images, of one value per image.
  template <typename T>
  std::span<const T> of(std::span<const T> values) const {
    const ImageRange there = within(values.size());
    return values.subspan(there.first, there.count);
  }
};

}  // namespace insonate
