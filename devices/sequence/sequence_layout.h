#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/image_headers/element_type.h"

// The size of a sequence as its header claims it, for all formats.

namespace insonate {

/// Header fields by name, as views of the file's bytes.
using HeaderFields = std::map<std::string_view, std::string_view>;

/// The remedy for a header that its writer wrote incorrectly.
inline constexpr const char* kExportAgain = "record or export the file again";

/// The longest side of an image that is read, pixels: that of the largest texture of most graphics cards.
inline constexpr std::uint64_t kLongestImageSide = 16384;
/// The most bytes of a frame's image that is read, with all its slices: zlib counts to 4 GiB.
inline constexpr std::uint64_t kMaxImageBytes = std::uint64_t(1) << 30;

/// Form of one frame's image in a file whose frames are stored one after the other.
struct ImageForm {
  std::uint64_t width = 0, height = 0;  ///< pixels, above 0; for a stack of slices those of the first
  std::uint64_t channels = 1;           ///< values per pixel, stored one after the other
  ElementType type = ElementType::uint8;
  bool big_endian = false;
  bool compressed = false;        ///< zlib (MetaImage) or gzip (NRRD)
  std::uint64_t frame_bytes = 0;  ///< bytes of one frame, uncompressed
};

/// Number of frames, and size of their images.
struct SequenceLayout {
  std::uint64_t frames = 0;       ///< at least 1; only a claim, so do not allocate memory by it alone
  bool has_images = false;        ///< false for transform-only files, whose images have zero pixels or one
  std::uint64_t image_bytes = 0;  ///< bytes of all frames, as stored; no more than there are
  /// Empty without images, if frames are not stored one after the other, or if an image is too large to be read.
  std::optional<ImageForm> form;
};

/// What a header states about its images.
struct ClaimedImages {
  std::vector<std::uint64_t> sizes;     ///< of each dimension
  std::vector<std::string_view> kinds;  ///< kind of each dimension; none: the last one counts the frames
  ElementType type = ElementType::uint8;
  std::uint64_t channels = 1;
  bool big_endian = false;
  bool compressed = false;
  std::optional<std::uint64_t> compressed_bytes;  ///< if the header states it
  std::string_view sizes_name, sizes_text;        ///< for error messages: "DimSize", "640 480 30"
  std::string_view kinds_name, kinds_text;
};

/// Returns whether the number of dimensions in a header agrees with its sizes and their kinds. PLUS counts the
/// dimension of frames even where it omits its size, because there is only one frame. It does not count the colour
/// dimension of a MetaImage.
bool dimensions_agree(std::optional<std::size_t> dimensions, const ClaimedImages& claimed);

/// Finds the dimension that counts the frames, which is missing in PLUS files with a single frame. Checks that the
/// images are, or can be, present in the `bytes_after` bytes after the header. Throws InputError if they are not, or if
/// the claims contradict each other or exceed what any file can hold.
SequenceLayout sequence_layout(const ClaimedImages& claimed, std::uint64_t bytes_after, const std::string& file);

}  // namespace insonate
