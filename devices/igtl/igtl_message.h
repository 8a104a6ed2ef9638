#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"

// Messages of OpenIGTLink as bytes and as values: pure functions, no sockets. The format is that of
// https://github.com/openigtlink/OpenIGTLink/tree/master/Documents/Protocol: numbers big-endian, a header of 58 bytes,
// a body of the size that the header tells. Lengths in mm.
namespace insonate::igtl {

inline constexpr std::size_t kHeaderBytes = 58;
inline constexpr std::uint16_t kDefaultPort = 18944;

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

struct Header {
  std::uint16_t version = 1;
  std::string type;         ///< up to 12 characters: "TRANSFORM"
  std::string name;         ///< of the device, up to 20: "ProbeToTracker"
  std::uint64_t stamp = 0;  ///< seconds since 1970 in units of 2^-32; 0 when the sender tells none
  std::uint64_t body_bytes = 0;
  std::uint64_t crc = 0;  ///< of the body
};

/// CRC-64 of ECMA-182: polynomial 0x42F0E1EBA9EA3693, starting at 0, unreflected.
std::uint64_t crc64(ByteView bytes, std::uint64_t before = 0);

Header parse_header(std::span<const std::uint8_t, kHeaderBytes> bytes);

/// The parts of a body. Versions 2 and 3 have an extended header before the content and metadata behind it.
struct Parts {
  ByteView content;
  ByteView metadata_index;
  ByteView metadata;
};
/// Empty when the sizes in it do not fit.
std::optional<Parts> parts_of(const Header& header, ByteView body);

/// The value of a key of the metadata, at most 64 characters; empty when there is none.
std::string metadata_value(const Parts& parts, std::string_view key);

/// The matrix of a TRANSFORM. Empty when the content has another size; any numbers pass.
std::optional<glm::dmat4> parse_transform(ByteView content);

/// What a STATUS says.
struct Status {
  std::uint16_t code = 0;  ///< 1: all is well; the others are the protocol's
  std::string text;        ///< for people; at most 200 characters
};
inline constexpr std::uint16_t kStatusOk = 1;
std::optional<Status> parse_status(ByteView content);

/// Seconds since 1970 as a header's stamp, and back.
std::uint64_t stamp_of(double seconds);
double seconds_of(std::uint64_t stamp);

// Whole messages, header version 1. A name longer than 20 characters is cut.

Bytes make_message(std::string_view type, std::string_view name, std::uint64_t stamp, ByteView body);
Bytes make_transform(std::string_view name, std::uint64_t stamp, const Pose& pose);
Bytes make_status(std::string_view name, std::uint64_t stamp, const Status& status);
/// Text beyond 65535 bytes is cut.
Bytes make_string(std::string_view name, std::uint64_t stamp, std::string_view text);
/// A grey picture in space: its pixel (0, 0) is the first, rows go along `image_from`'s x and columns along its y, both
/// of length `mm_per_pixel`, and the origin of `pose` is the middle of the picture. Coordinates are said to be RAS.
Bytes make_image(std::string_view name, std::uint64_t stamp, const Image<std::uint8_t>& picture, const Pose& pose,
                 double mm_per_pixel);

}  // namespace insonate::igtl
