#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"

// Converts OpenIGTLink messages between bytes and values: pure functions, no sockets. The format is that of
// https://github.com/openigtlink/OpenIGTLink/tree/master/Documents/Protocol: big-endian numbers, a header of 58 bytes,
// and a body of the size that the header states. Lengths are in mm.
namespace insonate::igtl {

inline constexpr std::size_t kHeaderBytes = 58;
inline constexpr std::uint16_t kDefaultPort = 18944;

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// Header of a message.
struct Header {
  std::uint16_t version = 1;
  std::string type;         ///< up to 12 characters: "TRANSFORM"
  std::string name;         ///< name of the device, up to 20 characters: "ProbeToTracker"
  std::uint64_t stamp = 0;  ///< seconds since 1970 in units of 2^-32; 0 if the sender gives none
  std::uint64_t body_bytes = 0;
  std::uint64_t crc = 0;  ///< of the body
};

/// Returns the CRC-64 of ECMA-182: polynomial 0x42F0E1EBA9EA3693, initial value 0, not reflected.
std::uint64_t crc64(ByteView bytes, std::uint64_t before = 0);

/// Reads the fields of a header. Checks nothing.
Header parse_header(std::span<const std::uint8_t, kHeaderBytes> bytes);

/// The parts of a body. Versions 2 and 3 have an extended header before the content and metadata behind it.
struct Parts {
  ByteView content;
  ByteView metadata_index;
  ByteView metadata;
};
/// Splits a body. Returns nothing if the sizes in it do not fit.
std::optional<Parts> parts_of(const Header& header, ByteView body);

/// Returns the metadata value of `key`, cut to 64 characters; empty if there is none.
std::string metadata_value(const Parts& parts, std::string_view key);

/// Returns the matrix of a TRANSFORM. Empty if the content has another size; the numbers are not checked.
std::optional<glm::dmat4> parse_transform(ByteView content);

/// An IMAGE message with one slice.
struct ReceivedImage {
  Image<std::uint8_t> grey;  ///< the message's pixel (0, 0) first
  /// Maps (column, row, 0), the centre of a pixel, to mm in the frame that the sender placed the image in.
  glm::dmat4 frame_from_pixel{1.0};
  double time_s = 0;  ///< on the clock of the poses
};

/// Returns the image of an IMAGE message, or why it is not one that can be used, as a part of a sentence: "... has 3
/// slices". Values of unsigned bytes are unchanged. Other types are scaled so that the largest value becomes 255, and
/// negative values become 0. Colours (three or four components) become their luminance (BT.601). The format is that of
/// https://github.com/openigtlink/OpenIGTLink/blob/master/Documents/Protocol/image.md.
std::variant<ReceivedImage, std::string> parse_image(ByteView content);

/// Content of a STATUS message.
struct Status {
  std::uint16_t code = 0;  ///< 1: no error; the protocol defines the others
  std::string text;        ///< for users; at most 200 characters
};
inline constexpr std::uint16_t kStatusOk = 1;
/// Returns the content of a STATUS message; nothing if it is too short.
std::optional<Status> parse_status(ByteView content);

/// Converts seconds since 1970 to a header's time stamp, and back.
std::uint64_t stamp_of(double seconds);
double seconds_of(std::uint64_t stamp);

// The next functions return whole messages with header version 1. Names longer than 20 characters are cut.

Bytes make_message(std::string_view type, std::string_view name, std::uint64_t stamp, ByteView body);
Bytes make_transform(std::string_view name, std::uint64_t stamp, const Pose& pose);
Bytes make_status(std::string_view name, std::uint64_t stamp, const Status& status);
/// Cuts text beyond 65535 bytes.
Bytes make_string(std::string_view name, std::uint64_t stamp, std::string_view text);
/// Makes an IMAGE message of a greyscale picture in space. Its pixel (0, 0) comes first. Rows run along the x axis of
/// `pose` and columns along its y axis, both with `mm_per_pixel`. The translation of `pose` is the centre of the
/// picture. The message declares its coordinates as RAS.
Bytes make_image(std::string_view name, std::uint64_t stamp, const Image<std::uint8_t>& picture, const Pose& pose,
                 double mm_per_pixel);

}  // namespace insonate::igtl
