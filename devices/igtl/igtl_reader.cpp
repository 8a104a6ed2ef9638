#include "devices/igtl/igtl_reader.h"

#include <algorithm>
#include <utility>

namespace insonate::igtl {
namespace {

/// Checks the version among others; a different first pair of bytes belongs to another protocol.
bool plausible(const Header& header) {
  return header.version >= 1 && header.version <= 3 && !header.type.empty() &&
         header.body_bytes <= MessageReader::kMaxPassed;
}

}  // namespace

MessageReader::Damage MessageReader::feed(ByteView bytes) {
  Damage damage = Damage::none;
  const auto take_up_to = [&](std::uint64_t count) {
    const ByteView taken = bytes.first(std::size_t(std::min<std::uint64_t>(count, bytes.size())));
    bytes = bytes.subspan(taken.size());
    return taken;
  };
  while (!bytes.empty()) {
    if (passing_ > 0) {
      passing_ -= take_up_to(passing_).size();
      continue;
    }
    const std::size_t whole = in_body_ ? std::size_t(header_.body_bytes) : kHeaderBytes;
    const ByteView piece = take_up_to(whole - kept_.size());
    kept_.insert(kept_.end(), piece.begin(), piece.end());
    if (kept_.size() < whole) continue;
    if (!in_body_) {
      header_ = parse_header(std::span<const std::uint8_t, kHeaderBytes>(kept_));
      kept_.clear();
      if (!plausible(header_)) return Damage::not_igtl;
      if (!wanted_(header_) || header_.body_bytes > most_kept_) {
        passing_ = header_.body_bytes;
        continue;
      }
      in_body_ = true;
      if (header_.body_bytes > 0) continue;
    }
    in_body_ = false;
    const Bytes body = std::exchange(kept_, {});
    if (crc64(body) != header_.crc) {
      damage = Damage::crc;
      continue;
    }
    take_(header_, body);
  }
  return damage;
}

}  // namespace insonate::igtl
