#include "devices/sequence/sequence_layout.h"

#include <algorithm>
#include <initializer_list>
#include <limits>

#include "sim/core/input_error.h"
#include "sim/image_headers/header_text.h"

namespace insonate {
namespace {

/// How many bytes one byte of a deflate stream can stand for (zlib's technical details:
/// https://zlib.net/zlib_tech.html).
constexpr std::uint64_t kMaxCompression = 1032;

std::size_t count_kinds(const ClaimedImages& claimed, std::initializer_list<std::string_view> names) {
  return std::size_t(std::count_if(claimed.kinds.begin(), claimed.kinds.end(), [&](std::string_view kind) {
    return std::any_of(names.begin(), names.end(),
                       [&](std::string_view name) { return same_ignoring_case(kind, name); });
  }));
}

/// Returns whether there is a single image, possibly in colour: a PLUS file with one frame.
bool is_single(const ClaimedImages& claimed) {
  const std::size_t domains = count_kinds(claimed, {"domain"});
  return domains == 2 && domains + count_kinds(claimed, {"vector"}) == claimed.kinds.size();
}

/// Returns which dimension counts the frames: the one whose kind states it, else the last. Nothing if there is only one
/// frame.
std::optional<std::size_t> list_axis(const ClaimedImages& claimed, const std::string& file) {
  if (claimed.kinds.empty()) return claimed.sizes.size() - 1;
  const bool each = claimed.kinds.size() == claimed.sizes.size();
  if (each && is_single(claimed)) return std::nullopt;
  const auto is_list = [](std::string_view kind) {
    return same_ignoring_case(kind, "list") || same_ignoring_case(kind, "time");
  };
  if (!each || count_kinds(claimed, {"list", "time"}) != 1)
    throw InputError(file, "header",
                     std::string(claimed.kinds_name) + " is " + quoted(claimed.kinds_text) + ", where each of the " +
                         std::to_string(claimed.sizes.size()) + " dimensions has a kind and one of them is 'list'",
                     kExportAgain);
  return std::size_t(std::find_if(claimed.kinds.begin(), claimed.kinds.end(), is_list) - claimed.kinds.begin());
}

/// Returns the bytes of all images; 0 if a dimension is 0.
std::uint64_t raw_bytes(const ClaimedImages& claimed, const std::string& file) {
  std::vector<std::uint64_t> factors = claimed.sizes;
  factors.push_back(bytes_of(claimed.type));
  factors.push_back(claimed.channels);
  if (std::find(factors.begin(), factors.end(), 0u) != factors.end()) return 0;
  std::uint64_t product = 1;
  for (const std::uint64_t factor : factors) {
    if (product > std::numeric_limits<std::uint64_t>::max() / factor)
      throw InputError(
          file, "header",
          std::string(claimed.sizes_name) + " " + quoted(claimed.sizes_text) + " is more than any file holds",
          kExportAgain);
    product *= factor;
  }
  return product;
}

/// Returns the form of an image if the frames are stored one after the other, which means that their dimension is the
/// last. 3D Slicer can put it first, so that each pixel's values of all frames are adjacent.
std::optional<ImageForm> image_form(const ClaimedImages& claimed, std::optional<std::size_t> frame_axis) {
  if (frame_axis && *frame_axis + 1 != claimed.sizes.size()) return std::nullopt;
  ImageForm form;
  form.channels = claimed.channels;
  form.type = claimed.type;
  form.big_endian = claimed.big_endian;
  form.compressed = claimed.compressed;
  form.frame_bytes = bytes_of(claimed.type) * claimed.channels;
  std::vector<std::uint64_t> lengths;
  for (std::size_t i = 0; i < claimed.sizes.size(); ++i) {
    if (i == frame_axis) continue;
    form.frame_bytes *= claimed.sizes[i];
    const bool is_colour = i < claimed.kinds.size() && same_ignoring_case(claimed.kinds[i], "vector");
    if (is_colour && i > 0) return std::nullopt;  // one plane per colour
    if (is_colour)
      form.channels *= claimed.sizes[i];
    else
      lengths.push_back(claimed.sizes[i]);
  }
  if (lengths.size() < 2) return std::nullopt;
  form.width = lengths[0];
  form.height = lengths[1];
  if (std::max(form.width, form.height) > kLongestImageSide || form.frame_bytes > kMaxImageBytes) return std::nullopt;
  return form;
}

}  // namespace

bool dimensions_agree(std::optional<std::size_t> dimensions, const ClaimedImages& claimed) {
  const std::size_t sizes = claimed.sizes.size(), most = is_single(claimed) ? sizes + 1 : sizes;
  return dimensions && most >= 3 && *dimensions + count_kinds(claimed, {"vector"}) >= sizes && *dimensions <= most;
}

SequenceLayout sequence_layout(const ClaimedImages& claimed, std::uint64_t bytes_after, const std::string& file) {
  const std::optional<std::size_t> frame_axis = list_axis(claimed, file);
  SequenceLayout layout;
  layout.frames = frame_axis ? claimed.sizes[*frame_axis] : 1;
  if (layout.frames == 0)
    throw InputError(file, "header", std::string(claimed.sizes_name) + " says that there are no frames",
                     "record the scan again");
  const std::uint64_t raw = raw_bytes(claimed, file);
  bool single_pixel = true;
  for (std::size_t i = 0; i < claimed.sizes.size(); ++i)
    if (i != frame_axis) single_pixel = single_pixel && claimed.sizes[i] == 1;
  layout.has_images = raw > 0 && !single_pixel;
  if (layout.has_images) layout.form = image_form(claimed, frame_axis);
  if (raw == 0) return layout;
  // PLUS's transform-only files state 1 x 1 and hold one pixel per frame. Others state this and hold none, or a line
  // end.
  if (single_pixel && (claimed.compressed || bytes_after <= 2)) return layout;
  // Writers that fill in the compressed size at the end leave 0 if they are stopped before.
  layout.image_bytes = claimed.compressed ? std::max<std::uint64_t>(claimed.compressed_bytes.value_or(1), 1) : raw;
  if (bytes_after < layout.image_bytes)
    throw InputError(file, "image data",
                     "it is truncated: " + std::to_string(bytes_after) + " bytes of " +
                         std::to_string(layout.image_bytes) + " are there",
                     "copy or record the file again");
  if (claimed.compressed && raw / kMaxCompression > bytes_after)
    throw InputError(file, "image data",
                     "it is truncated: " + std::to_string(bytes_after) + " bytes cannot hold images of " +
                         std::to_string(raw) + " bytes, even compressed",
                     "copy or record the file again");
  return layout;
}

}  // namespace insonate
