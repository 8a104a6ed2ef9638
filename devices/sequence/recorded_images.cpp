#include "devices/sequence/recorded_images.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <new>
#include <utility>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr std::size_t kInflatedAtOnce = 1 << 16;
constexpr std::uint64_t kBetweenPlaces = 16 << 20;

double value_at(const std::uint8_t* bytes, const ImageForm& form) {
  return with_type(form.type, [&](auto zero) { return double(number_at<decltype(zero)>(bytes, form.big_endian)); });
}

/// Returns the luminance of a pixel. With one or two channels the first is the grey value.
double brightness_at(const std::uint8_t* bytes, const ImageForm& form) {
  if (form.channels < 3) return value_at(bytes, form);
  const std::uint64_t step = bytes_of(form.type);
  return 0.299 * value_at(bytes, form) + 0.587 * value_at(bytes + step, form) +
         0.114 * value_at(bytes + 2 * step, form);
}

}  // namespace

/// Reads the images' bytes from any offset.
class ImageReader::Bytes {
public:
  explicit Bytes(const RecordedImages& images) : images_(images), stream_(images.file, std::ios::binary) {
    if (!stream_) throw InputError(images.file.string(), "", "it cannot be read", "check its permissions");
  }
  ~Bytes() {
    for (auto& [at, place] : places_) inflateEnd(&place.state);
    if (inflating_) inflateEnd(&state_);
  }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;

  void read(std::uint64_t from, std::uint8_t* to, std::size_t count) {
    if (!images_.form.compressed) {
      seek(images_.offset + from);
      stream_.read(reinterpret_cast<char*>(to), std::streamsize(count));
      if (std::size_t(stream_.gcount()) != count) fail_end();
      return;
    }
    go_to(from);
    std::vector<std::uint8_t> skipped(kInflatedAtOnce);
    while (at_ < from) inflate_some(skipped.data(), std::size_t(std::min<std::uint64_t>(kInflatedAtOnce, from - at_)));
    inflate_some(to, count);
  }

private:
  /// A restart point for decompression.
  struct Place {
    z_stream state{};
    std::uint64_t file_at = 0;  ///< offset of the next compressed byte in the file
  };

  [[noreturn]] void fail_end() const {
    throw InputError(images_.file.string(), "image data", "it ends before the last image", "copy the file again");
  }
  [[noreturn]] void fail_damaged() const {
    throw InputError(images_.file.string(), "image data", "it cannot be decompressed", "copy the file again");
  }

  void seek(std::uint64_t at) {
    stream_.clear();
    stream_.seekg(std::streamoff(at));
  }

  /// Moves to the best place to continue to `from`: the current position, a restart point, or the beginning.
  void go_to(std::uint64_t from) {
    const auto behind = places_.upper_bound(from);
    const auto place = behind == places_.begin() ? places_.end() : std::prev(behind);
    if (inflating_ && at_ <= from && (place == places_.end() || place->first <= at_)) return;
    if (inflating_) inflateEnd(&state_);
    inflating_ = false;
    state_ = {};
    input_.resize(kInflatedAtOnce);
    if (place == places_.end()) {
      // 15 bits of window; detects zlib's or gzip's header.
      if (inflateInit2(&state_, 15 + 32) != Z_OK) throw std::bad_alloc();
      at_ = 0;
      file_at_ = images_.offset;
    } else {
      if (inflateCopy(&state_, &place->second.state) != Z_OK) throw std::bad_alloc();
      state_.avail_in = 0;
      at_ = place->first;
      file_at_ = place->second.file_at;
    }
    inflating_ = true;
  }

  void inflate_some(std::uint8_t* to, std::size_t count) {
    state_.next_out = to;
    state_.avail_out = uInt(count);
    while (state_.avail_out > 0) {
      if (state_.avail_in == 0) refill();
      const uInt before = state_.avail_out;
      const int result = inflate(&state_, Z_NO_FLUSH);
      at_ += before - state_.avail_out;
      if (result == Z_STREAM_END && state_.avail_out > 0) fail_end();
      if (result != Z_OK && result != Z_STREAM_END) fail_damaged();
      keep_place();
    }
  }

  void refill() {
    seek(file_at_);
    stream_.read(reinterpret_cast<char*>(input_.data()), std::streamsize(input_.size()));
    if (stream_.gcount() == 0) fail_end();
    file_at_ += std::uint64_t(stream_.gcount());
    state_.next_in = input_.data();
    state_.avail_in = uInt(stream_.gcount());
  }

  void keep_place() {
    if (at_ < (places_.empty() ? 0 : places_.rbegin()->first) + kBetweenPlaces) return;
    // The state is created in the map before the copy: zlib ties a state to its address.
    Place& place = places_[at_];
    if (inflateCopy(&place.state, &state_) != Z_OK) throw std::bad_alloc();
    place.file_at = file_at_ - state_.avail_in;
  }

  const RecordedImages& images_;
  std::ifstream stream_;
  std::vector<std::uint8_t> input_;
  z_stream state_{};
  bool inflating_ = false;
  std::uint64_t at_ = 0;       ///< offset of the next byte of the images
  std::uint64_t file_at_ = 0;  ///< offset of the next byte to read from the file
  std::map<std::uint64_t, Place> places_;
};

ImageReader::ImageReader(RecordedImages images) : images_(std::move(images)) {
  bytes_ = std::make_unique<Bytes>(images_);
}

ImageReader::~ImageReader() = default;

const Image<std::uint8_t>& ImageReader::grey(std::uint64_t number) {
  if (number == number_) return picture_;
  number_.reset();
  const ImageForm& form = images_.form;
  try {
    frame_.resize(std::size_t(form.frame_bytes));
  } catch (const std::bad_alloc&) {
    throw InputError(images_.file.string(), "image data",
                     "there is not enough memory for one image of " + std::to_string(form.frame_bytes) + " bytes",
                     "close other programs, or record smaller images");
  }
  bytes_->read(number * form.frame_bytes, frame_.data(), frame_.size());

  const auto width = std::size_t(form.width), height = std::size_t(form.height);
  const std::size_t step = std::size_t(bytes_of(form.type) * form.channels);
  double scale = 1;
  if (form.type != ElementType::uint8) {
    double largest = 0;
    for (std::size_t i = 0; i < width * height; ++i) {
      const double value = brightness_at(&frame_[i * step], form);
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
    scale = largest > 0 ? 255 / largest : 0;
  }
  picture_ = Image<std::uint8_t>(int(width), int(height));
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t from_x = images_.mirrored ? width - 1 - x : x;
      const std::size_t from_y = images_.upside_down ? height - 1 - y : y;
      const double value = brightness_at(&frame_[(from_y * width + from_x) * step], form) * scale;
      picture_.at(int(x), int(y)) = std::isfinite(value) ? std::uint8_t(std::lround(std::clamp(value, 0.0, 255.0))) : 0;
    }
  number_ = number;
  return picture_;
}

}  // namespace insonate
