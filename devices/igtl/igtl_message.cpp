#include "devices/igtl/igtl_message.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace insonate::igtl {
namespace {

constexpr std::size_t kTypeBytes = 12, kNameBytes = 20;
constexpr std::size_t kMaxStatusText = 200;

constexpr std::array<std::uint64_t, 256> kCrcTable = [] {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t crc = byte << 56;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ (crc >> 63 ? 0x42F0E1EBA9EA3693u : 0);
    table[byte] = crc;
  }
  return table;
}();

template <typename T>
T number_at(ByteView bytes, std::size_t at) {
  T number = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) number = T(number << 8) | T(bytes[at + i]);
  return number;
}

/// Returns the text up to the first zero byte; characters that are not printable become question marks.
std::string text_of(ByteView bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    if (byte == 0) break;
    text += byte >= 0x20 && byte < 0x7F ? char(byte) : '?';
  }
  return text;
}

template <typename T>
void put(Bytes& bytes, T number) {
  for (std::size_t i = sizeof(T); i-- > 0;) bytes.push_back(std::uint8_t(number >> (8 * i)));
}

void put_float(Bytes& bytes, double number) {
  put(bytes, std::bit_cast<std::uint32_t>(float(number)));
}

/// Cuts the text to `width`, or pads it with zeros.
void put_text(Bytes& bytes, std::string_view text, std::size_t width) {
  text = text.substr(0, width);
  bytes.insert(bytes.end(), text.begin(), text.end());
  bytes.insert(bytes.end(), width - text.size(), 0);
}

void put_vector(Bytes& bytes, const glm::dvec3& vector) {
  for (int axis = 0; axis < 3; ++axis) put_float(bytes, vector[axis]);
}

}  // namespace

std::uint64_t crc64(ByteView bytes, std::uint64_t before) {
  for (const std::uint8_t byte : bytes) before = (before << 8) ^ kCrcTable[(before >> 56) ^ byte];
  return before;
}

Header parse_header(std::span<const std::uint8_t, kHeaderBytes> bytes) {
  Header header;
  header.version = number_at<std::uint16_t>(bytes, 0);
  header.type = text_of(bytes.subspan(2, kTypeBytes));
  header.name = text_of(bytes.subspan(14, kNameBytes));
  header.stamp = number_at<std::uint64_t>(bytes, 34);
  header.body_bytes = number_at<std::uint64_t>(bytes, 42);
  header.crc = number_at<std::uint64_t>(bytes, 50);
  return header;
}

std::optional<Parts> parts_of(const Header& header, ByteView body) {
  if (header.version < 2) return Parts{body, {}, {}};
  // u16 size of the extended header, u16 size of the metadata's index, u32 size of the metadata, u32 message number
  constexpr std::size_t kMin = 12;
  if (body.size() < kMin) return std::nullopt;
  const std::size_t extended = number_at<std::uint16_t>(body, 0), index = number_at<std::uint16_t>(body, 2);
  const std::uint64_t values = number_at<std::uint32_t>(body, 4);
  if (extended < kMin || extended + index + values > body.size()) return std::nullopt;
  const std::size_t content = body.size() - extended - index - std::size_t(values);
  return Parts{body.subspan(extended, content), body.subspan(extended + content, index),
               body.subspan(extended + content + index)};
}

std::string metadata_value(const Parts& parts, std::string_view key) {
  // u16 count, then for each entry u16 size of the key, u16 encoding, u32 size of the value. Keys and values are stored
  // one after the other.
  constexpr std::size_t kEntry = 8, kMaxText = 64;
  const ByteView index = parts.metadata_index;
  std::uint64_t at = 0;
  for (std::size_t entry = 2; entry + kEntry <= index.size(); entry += kEntry) {
    const std::uint64_t key_size = number_at<std::uint16_t>(index, entry);
    const std::uint64_t value_size = number_at<std::uint32_t>(index, entry + 4);
    if (at + key_size + value_size > parts.metadata.size()) return {};
    const ByteView found = parts.metadata.subspan(std::size_t(at), std::size_t(key_size));
    const ByteView value = parts.metadata.subspan(std::size_t(at + key_size), std::size_t(value_size));
    if (std::equal(found.begin(), found.end(), key.begin(), key.end()))
      return text_of(value.first(std::min(value.size(), kMaxText)));
    at += key_size + value_size;
  }
  return {};
}

std::optional<glm::dmat4> parse_transform(ByteView content) {
  if (content.size() != 48) return std::nullopt;
  glm::dmat4 matrix(1.0);
  for (std::size_t i = 0; i < 12; ++i)
    matrix[int(i / 3)][int(i % 3)] = double(std::bit_cast<float>(number_at<std::uint32_t>(content, 4 * i)));
  return matrix;
}

std::optional<Status> parse_status(ByteView content) {
  // u16 code, i64 subcode, 20 characters of the error's name, then the text
  constexpr std::size_t kText = 30;
  if (content.size() < kText) return std::nullopt;
  const ByteView text = content.subspan(kText);
  return Status{number_at<std::uint16_t>(content, 0), text_of(text.first(std::min(text.size(), kMaxStatusText)))};
}

std::uint64_t stamp_of(double seconds) {
  const double whole = std::floor(seconds);
  return (std::uint64_t(whole) << 32) | std::uint64_t(std::ldexp(seconds - whole, 32));
}

double seconds_of(std::uint64_t stamp) {
  return std::ldexp(double(stamp), -32);
}

Bytes make_message(std::string_view type, std::string_view name, std::uint64_t stamp, ByteView body) {
  Bytes bytes;
  bytes.reserve(kHeaderBytes + body.size());
  put<std::uint16_t>(bytes, 1);
  put_text(bytes, type, kTypeBytes);
  put_text(bytes, name, kNameBytes);
  put(bytes, stamp);
  put(bytes, std::uint64_t(body.size()));
  put(bytes, crc64(body));
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

Bytes make_transform(std::string_view name, std::uint64_t stamp, const Pose& pose) {
  Bytes body;
  for (int column = 0; column < 3; ++column) put_vector(body, pose.rotation[column]);
  put_vector(body, pose.translation);
  return make_message("TRANSFORM", name, stamp, body);
}

Bytes make_status(std::string_view name, std::uint64_t stamp, const Status& status) {
  Bytes body;
  put(body, status.code);
  put<std::uint64_t>(body, 0);
  put_text(body, status.code == kStatusOk ? "OK" : "Error", 20);
  put_text(body, status.text, std::min(status.text.size(), kMaxStatusText));
  body.push_back(0);
  return make_message("STATUS", name, stamp, body);
}

Bytes make_string(std::string_view name, std::uint64_t stamp, std::string_view text) {
  text = text.substr(0, 0xFFFF);
  Bytes body;
  put<std::uint16_t>(body, 106);  // UTF-8 in IANA's numbering of character sets
  put(body, std::uint16_t(text.size()));
  body.insert(body.end(), text.begin(), text.end());
  return make_message("STRING", name, stamp, body);
}

Bytes make_image(std::string_view name, std::uint64_t stamp, const Image<std::uint8_t>& picture, const Pose& pose,
                 double mm_per_pixel) {
  Bytes body;
  body.reserve(72 + picture.pixels.size());
  put<std::uint16_t>(body, 1);            // version of the IMAGE header
  body.insert(body.end(), {1, 3, 1, 1});  // one component, unsigned bytes, big-endian, RAS
  const std::array<std::uint16_t, 3> size{std::uint16_t(picture.width), std::uint16_t(picture.height), 1};
  for (const std::uint16_t n : size) put(body, n);
  put_vector(body, pose.rotation[0] * mm_per_pixel);
  put_vector(body, pose.rotation[1] * mm_per_pixel);
  put_vector(body, pose.rotation[2]);  // a slice 1 mm thick
  put_vector(body, pose.translation);
  for (int axis = 0; axis < 3; ++axis) put<std::uint16_t>(body, 0);
  for (const std::uint16_t n : size) put(body, n);
  body.insert(body.end(), picture.pixels.begin(), picture.pixels.end());
  return make_message("IMAGE", name, stamp, body);
}

}  // namespace insonate::igtl
