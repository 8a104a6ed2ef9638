#pragma once

#include <functional>

#include "devices/igtl/igtl_message.h"

namespace insonate::igtl {

/// Splits a stream of bytes, which arrives in pieces of any size, into messages.
///
/// It stores one header and one body of at most `most_kept` bytes, whatever sizes the stream announces. Bodies of
/// unwanted types and bodies that are too large are skipped by their size.
class MessageReader {
public:
  /// Enough for every kind of message with a few numbers or a sentence in it.
  static constexpr std::uint64_t kMaxKept = std::uint64_t(64) * 1024;
  /// Enough for an image of 1920 x 1080 pixels with four bytes each, twice.
  static constexpr std::uint64_t kMaxKeptWithImages = std::uint64_t(16) * 1024 * 1024;
  /// A volume of 512 x 512 x 256 voxels of 16 bits, with room to spare. A larger announced body means that it is not a
  /// message.
  static constexpr std::uint64_t kMaxPassed = 512ull * 1024 * 1024;

  enum class Damage { none, crc, not_igtl };

  /// `wanted` returns whether to store a message's body; it sees the headers of bodies that are too large as well.
  /// `take` receives the bodies that arrived undamaged.
  MessageReader(std::function<bool(const Header&)> wanted, std::function<void(const Header&, ByteView)> take,
                std::uint64_t most_kept = kMaxKept)
      : wanted_(std::move(wanted)), take_(std::move(take)), most_kept_(most_kept) {}

  /// Parses the next bytes. Returns not_igtl if the stream cannot be read further, or crc if at least one message was
  /// damaged and was skipped.
  Damage feed(ByteView bytes);

  /// Returns whether the bytes so far end inside a message, including a skipped one.
  bool in_message() const { return in_body_ || !kept_.empty() || passing_ > 0; }

private:
  std::function<bool(const Header&)> wanted_;
  std::function<void(const Header&, ByteView)> take_;
  std::uint64_t most_kept_;
  Bytes kept_;  ///< bytes of the current message: of its header, or of its body if in_body_
  Header header_;
  bool in_body_ = false;
  std::uint64_t passing_ = 0;  ///< bytes still to skip
};

}  // namespace insonate::igtl
