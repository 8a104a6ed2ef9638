#include "igtl_promises.h"

#include <algorithm>
#include <variant>

#include "devices/igtl/igtl_reader.h"

namespace insonate::igtl {
namespace {

struct Seen {
  std::vector<Bytes> bodies;
  bool readable = true;
  std::string broken;
};

void parse_all(const Header& header, ByteView body, Seen& seen) {
  if (body.size() > MessageReader::kMaxKept) seen.broken = "a body is longer than any that is kept";
  if (body.size() != header.body_bytes) seen.broken = "a body is not as long as its header says";
  if (crc64(body) != header.crc) seen.broken = "a body with a wrong CRC came through";
  const auto parts = parts_of(header, body);
  if (!parts) return;
  if (parts->content.size() + parts->metadata_index.size() + parts->metadata.size() > body.size())
    seen.broken = "the parts are longer than the body";
  parse_transform(parts->content);
  if (const auto image = parse_image(parts->content); const auto* read = std::get_if<ReceivedImage>(&image))
    if (read->grey.pixels.size() > body.size()) seen.broken = "an image has more pixels than bytes";
  const auto status = parse_status(parts->content);
  if (status && status->text.size() > 200) seen.broken = "a status is longer than promised";
  if (metadata_value(*parts, "TransformStatus").size() > 64) seen.broken = "a value is longer than promised";
}

Seen read(ByteView bytes, std::size_t portion) {
  Seen seen;
  MessageReader reader([](const Header& header) { return header.name != "unwanted"; },
                       [&](const Header& header, ByteView body) {
                         parse_all(header, body, seen);
                         seen.bodies.emplace_back(body.begin(), body.end());
                       });
  while (!bytes.empty() && seen.readable) {
    const ByteView piece = bytes.first(std::min(portion, bytes.size()));
    seen.readable = reader.feed(piece) != MessageReader::Damage::not_igtl;
    bytes = bytes.subspan(piece.size());
  }
  return seen;
}

}  // namespace

std::string broken_promise(ByteView bytes, std::size_t portion) {
  const Seen whole = read(bytes, std::max<std::size_t>(1, bytes.size())), pieces = read(bytes, portion);
  if (!whole.broken.empty()) return whole.broken;
  if (!pieces.broken.empty()) return pieces.broken;
  if (whole.bodies != pieces.bodies || whole.readable != pieces.readable)
    return "the stream reads differently in portions";
  return "";
}

}  // namespace insonate::igtl
