#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/core/image.h"

namespace insonate {

/// Finds the pixels of a scanner's images that ever carry echo, apart from text, scales and logos around them.
///
///     EchoSeen seen;
///     for (...) seen.add(image);
///     const Image<std::uint8_t> mask = seen.mask();
class EchoSeen {
public:
  /// Adds an image: row 0 nearest to the probe. Throws std::invalid_argument if its size is not that of the images
  /// before.
  void add(const Image<std::uint8_t>& image);

  std::size_t images() const { return images_; }

  /// Returns the pixels that are brighter than the dark around the fan in any image, without two kinds of regions:
  /// those that are small beside the largest one, and those that hardly change from image to image while others do.
  /// Thin strokes belong to no region. Returns a mask without pixels if there is nothing of the kind.
  Image<std::uint8_t> mask() const;

private:
  Image<std::uint8_t> lowest_, highest_;
  std::size_t images_ = 0;
};

}  // namespace insonate
