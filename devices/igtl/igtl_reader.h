#pragma once

#include <functional>

#include "devices/igtl/igtl_message.h"

namespace insonate::igtl {

/// Cuts a stream of bytes, as it comes in pieces of any size, into messages.
///
/// It keeps one header and one body of at most kMostKept bytes, whatever the stream announces: bodies of types that
/// nobody asked for and bodies that are too large are passed over by their size, unseen.
class MessageReader {
public:
  /// Enough for every kind of message with a few numbers or a sentence in it.
  static constexpr std::uint64_t kMostKept = 64 * 1024;
  /// A volume of 512 x 512 x 256 voxels of 16 bits with room to spare; what announces more is no message.
  static constexpr std::uint64_t kMostPassed = 512ull * 1024 * 1024;

  enum class Damage { none, crc, not_igtl };

  /// `wanted` says whether a message's body is kept; `take` gets the bodies of those that are whole.
  MessageReader(std::function<bool(const Header&)> wanted, std::function<void(const Header&, ByteView)> take)
      : wanted_(std::move(wanted)), take_(std::move(take)) {}

  /// not_igtl means that the stream cannot be read on; crc that at least one message was not whole and was left out.
  Damage feed(ByteView bytes);

  /// Whether the bytes so far end within a message, be it one that is passed over.
  bool in_message() const { return in_body_ || !kept_.empty() || passing_ > 0; }

private:
  std::function<bool(const Header&)> wanted_;
  std::function<void(const Header&, ByteView)> take_;
  Bytes kept_;  ///< of the message under way: of its header, or in_body_ of its body
  Header header_;
  bool in_body_ = false;
  std::uint64_t passing_ = 0;  ///< bytes yet to be passed over
};

}  // namespace insonate::igtl
