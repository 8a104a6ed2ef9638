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

/// Where the images of a recorded scan lie: in its file, and in space. Holds no pixels.
struct RecordedImages {
  struct Frame {
    std::uint64_t number = 0;  ///< of the image in the file, from 0
    /// Takes (column, row, 0), the centre of a pixel of ImageReader::grey(), to mm in the probe's frame; empty where
    /// the recording does not place the image.
    std::optional<glm::dmat4> probe_from_pixel;
  };

  std::filesystem::path file;
  std::uint64_t offset = 0;  ///< of the first image's bytes in the file
  ImageForm form;
  bool mirrored = false;      ///< columns run to the unmarked side in the file
  bool upside_down = false;   ///< rows run to the probe in the file
  std::vector<Frame> frames;  ///< one per sample of the scan
};

/// Reads images of a recording one at a time, whatever the file's size: raw images from their place, compressed ones by
/// decompressing from the nearest place that was passed before. Such places are kept every 16 MiB of images, at about
/// 40 KiB each; apart from them one image is held.
///
///     ImageReader reader(*scan.images);
///     const Image<std::uint8_t>& picture = reader.grey(scan.images->frames[sample].number);
class ImageReader {
public:
  /// Opens the file. Throws InputError when it cannot be read.
  explicit ImageReader(RecordedImages images);
  ~ImageReader();
  ImageReader(const ImageReader&) = delete;
  ImageReader& operator=(const ImageReader&) = delete;

  /// Image `number` of the file in grey, row 0 nearest to the probe, columns towards the marker. Values of 8 bits are
  /// kept, those of other types scaled from 0 to the image's largest one; colours become their luminance (BT.601).
  /// Valid until the next call. Throws InputError when the file's data end before it or cannot be decompressed.
  const Image<std::uint8_t>& grey(std::uint64_t number);

private:
  class Bytes;
  RecordedImages images_;
  std::unique_ptr<Bytes> bytes_;
  std::vector<std::uint8_t> frame_;
  Image<std::uint8_t> picture_;
  std::optional<std::uint64_t> number_;  ///< of `picture_`
};

}  // namespace insonate
