#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The size of a sequence as its header claims it, whatever the format.

namespace insonate {

/// What an element of an image is.
enum class PixelType { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 };

/// Bytes an element takes.
std::uint64_t bytes_of(PixelType type);

/// The form of one frame's image in a file whose frames lie one behind the other.
struct ImageForm {
  std::uint64_t width = 0, height = 0;  ///< pixels, above 0; of a stack of slices the first one is meant
  std::uint64_t channels = 1;           ///< values of a pixel, one behind the other
  PixelType type = PixelType::uint8;
  bool big_endian = false;
  bool compressed = false;        ///< zlib (MetaImage) or gzip (NRRD)
  std::uint64_t frame_bytes = 0;  ///< of one frame, not compressed
};

/// How many frames there are, and where their images end.
struct SequenceLayout {
  std::uint64_t frames = 0;       ///< at least 1; only claimed, so nothing may be allocated by it alone
  bool has_images = false;        ///< false for transform-only files, whose images have no pixel or one
  std::uint64_t image_bytes = 0;  ///< of all frames, as stored; no more than there are
  std::optional<ImageForm> form;  ///< of the images; empty without any, and where the frames do not lie one by one
};

/// What a header says of its images.
struct ClaimedImages {
  std::vector<std::uint64_t> sizes;     ///< of each dimension
  std::vector<std::string_view> kinds;  ///< of each dimension; none: the last one counts the frames
  PixelType type = PixelType::uint8;
  std::uint64_t channels = 1;
  bool big_endian = false;
  bool compressed = false;
  std::optional<std::uint64_t> compressed_bytes;  ///< where the header tells
  std::string_view sizes_name, sizes_text;        ///< for messages: "DimSize", "640 480 30"
  std::string_view kinds_name, kinds_text;
};

/// Whether the number of dimensions that a header tells goes with its sizes and their kinds. PLUS counts the frames
/// also where it leaves their size out, as there is but one, and does not count the colours of a MetaImage.
bool dimensions_agree(std::optional<std::size_t> dimensions, const ClaimedImages& claimed);

/// Finds the dimension that counts the frames, which is missing in a file of PLUS with a single one, and checks that
/// the images, of `bytes_after` bytes at most, are there. Throws InputError when they are not, or when what is claimed
/// contradicts itself or is more than any file holds.
SequenceLayout sequence_layout(const ClaimedImages& claimed, std::uint64_t bytes_after, const std::string& file);

}  // namespace insonate
