#pragma once

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/sequence/sequence_layout.h"
#include "sim/core/image.h"

namespace insonate {

/// Location of a recorded scan's images, in its file and in space. Holds no pixels.
struct RecordedImages {
  struct Frame {
    std::uint64_t number = 0;  ///< number of the image in the file, from 0
    /// Maps (column, row, 0), the centre of a pixel of ImageReader::grey(), to mm in the probe's frame. Empty if the
    /// recording does not place the image.
    std::optional<glm::dmat4> probe_from_pixel;
  };

  std::filesystem::path file;
  std::uint64_t offset = 0;  ///< offset of the first image's bytes in the file
  ImageForm form;
  bool mirrored = false;      ///< columns in the file run to the unmarked side
  bool upside_down = false;   ///< rows in the file run towards the probe
  std::vector<Frame> frames;  ///< one per sample of the scan
};

/// Reads images of a recording one at a time, from a file of any size. Raw images are read at their offset. Compressed
/// ones are decompressed from the nearest restart point that was passed before. Restart points are stored every 16 MiB
/// of images and take about 40 KiB each. Besides them, one image is in memory.
///
///     ImageReader reader(*scan.images);
///     const Image<std::uint8_t>& picture = reader.grey(scan.images->frames[sample].number);
class ImageReader {
public:
  /// Opens the file. Throws InputError if it cannot be read.
  explicit ImageReader(RecordedImages images);
  ~ImageReader();
  ImageReader(const ImageReader&) = delete;
  ImageReader& operator=(const ImageReader&) = delete;

  /// Returns image `number` of the file in grey, row 0 nearest to the probe, columns towards the marker. Values of 8
  /// bits are unchanged; other types are scaled so that the image's largest value becomes 255. Colours become their
  /// luminance (BT.601). Valid until the next call. Throws InputError if the file's data ends before it or cannot be
  /// decompressed.
  const Image<std::uint8_t>& grey(std::uint64_t number);

private:
  class Bytes;
  RecordedImages images_;
  std::unique_ptr<Bytes> bytes_;
  std::vector<std::uint8_t> frame_;
  Image<std::uint8_t> picture_;
  std::optional<std::uint64_t> number_;  ///< number of `picture_`
};

}  // namespace insonate
