#include "devices/igtl/igtl_message.h"

#include "igtl_promises.h"
#include <catch2/catch.hpp>
#include <glm/gtc/quaternion.hpp>
#include <igtlImageMessage.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTransformMessage.h>

#include <cstring>
#include <filesystem>

#include "devices/igtl/igtl_reader.h"
#include "sim/core/hash.h"
#include "sim/files/files.h"

namespace insonate::igtl {
namespace {

const Pose kPose{glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)))), {12.5, -40.25, 300.125}};

/// The messages of a stream whose bodies came through.
std::vector<std::pair<Header, Bytes>> read(const Bytes& stream) {
  std::vector<std::pair<Header, Bytes>> messages;
  MessageReader reader(
      [](const Header&) { return true; },
      [&](const Header& header, ByteView body) { messages.emplace_back(header, Bytes(body.begin(), body.end())); });
  reader.feed(stream);
  return messages;
}

/// Hands a message of ours to a message object of Debian's library; whether it takes it, CRC included.
bool unpack(::igtl::MessageBase* into, const Bytes& message) {
  into->InitPack();
  std::memcpy(into->GetPackPointer(), message.data(), kHeaderBytes);
  if (!(into->Unpack() & ::igtl::MessageHeader::UNPACK_HEADER)) return false;
  into->AllocatePack();
  REQUIRE(std::size_t(into->GetPackBodySize()) + kHeaderBytes == message.size());
  std::memcpy(into->GetPackBodyPointer(), message.data() + kHeaderBytes, message.size() - kHeaderBytes);
  return into->Unpack(1) & ::igtl::MessageHeader::UNPACK_BODY;
}

/// A TRANSFORM of version 2 with metadata, put together by the protocol's text.
Bytes with_metadata(const std::string& key, const std::string& value) {
  const Bytes old = make_transform("ProbeToTracker", 5, kPose);
  const auto u16 = [](std::size_t n) { return Bytes{std::uint8_t(n >> 8), std::uint8_t(n)}; };
  Bytes body{0, 12, 0, 10, 0, 0, 0, std::uint8_t(key.size() + value.size()), 0, 0, 0, 1};
  body.insert(body.end(), old.begin() + kHeaderBytes, old.end());
  for (const Bytes& piece : {u16(1), u16(key.size()), u16(3), u16(0), u16(value.size())})
    body.insert(body.end(), piece.begin(), piece.end());
  body.insert(body.end(), key.begin(), key.end());
  body.insert(body.end(), value.begin(), value.end());
  Bytes message = make_message("TRANSFORM", "ProbeToTracker", 5, body);
  message[1] = 2;
  return message;
}

}  // namespace

TEST_CASE("the CRC is that of ECMA-182") {
  // Check value of CRC-64/ECMA-182 over "123456789" in the catalogue of parametrised CRC algorithms (reveng).
  const std::string digits = "123456789";
  CHECK(crc64({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()}) == 0x6C40DF5F0B497347u);
}

TEST_CASE("Debian's library reads what is sent, and what it writes is read here") {
  const std::uint64_t stamp = stamp_of(1700000000.5);
  CHECK(seconds_of(stamp) == 1700000000.5);

  auto transform = ::igtl::TransformMessage::New();
  REQUIRE(unpack(transform, make_transform("ProbeToRas", stamp, kPose)));
  CHECK(std::string(transform->GetDeviceName()) == "ProbeToRas");
  ::igtl::Matrix4x4 matrix;
  transform->GetMatrix(matrix);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) CHECK(matrix[row][column] == float(kPose.rotation[column][row]));
    CHECK(matrix[row][3] == float(kPose.translation[row]));
  }
  auto time = ::igtl::TimeStamp::New();
  transform->GetTimeStamp(time);
  // The library counts in nanoseconds.
  CHECK(time->GetTimeStamp() == Approx(1700000000.5).margin(1e-6).epsilon(0));

  auto status = ::igtl::StatusMessage::New();
  REQUIRE(unpack(status, make_status("Exam", stamp, {kStatusOk, "step 2 of 3"})));
  CHECK(status->GetCode() == ::igtl::StatusMessage::STATUS_OK);
  CHECK(std::string(status->GetStatusString()) == "step 2 of 3");

  auto text = ::igtl::StringMessage::New();
  REQUIRE(unpack(text, make_string("Event", stamp, "frozen")));
  CHECK(std::string(text->GetString()) == "frozen");

  Image<std::uint8_t> picture(5, 3);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = std::uint8_t(7 * i);
  auto image = ::igtl::ImageMessage::New();
  REQUIRE(unpack(image, make_image("Ultrasound", stamp, picture, kPose, 0.25)));
  int size[3];
  float spacing[3];
  image->GetDimensions(size);
  image->GetSpacing(spacing);
  CHECK(size[0] == 5);
  CHECK(size[1] == 3);
  CHECK(size[2] == 1);
  CHECK(spacing[0] == Approx(0.25));
  CHECK(spacing[1] == Approx(0.25));
  CHECK(image->GetScalarType() == ::igtl::ImageMessage::TYPE_UINT8);
  CHECK(image->GetCoordinateSystem() == ::igtl::ImageMessage::COORDINATE_RAS);
  CHECK(std::memcmp(image->GetScalarPointer(), picture.pixels.data(), 15) == 0);
  ::igtl::Matrix4x4 place;
  image->GetMatrix(place);
  for (int row = 0; row < 3; ++row) {
    CHECK(place[row][0] == Approx(kPose.rotation[0][row]));
    CHECK(place[row][3] == Approx(kPose.translation[row]));
  }

  auto theirs = ::igtl::TransformMessage::New();
  theirs->SetDeviceName("StylusToTracker");
  theirs->SetMatrix(matrix);
  theirs->SetTimeStamp(time);
  theirs->Pack();
  const auto* bytes = static_cast<const std::uint8_t*>(theirs->GetPackPointer());
  const auto messages = read(Bytes(bytes, bytes + theirs->GetPackSize()));
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].first.type == "TRANSFORM");
  CHECK(messages[0].first.name == "StylusToTracker");
  CHECK(seconds_of(messages[0].first.stamp) == Approx(1700000000.5).margin(1e-6).epsilon(0));
  const auto parts = parts_of(messages[0].first, messages[0].second);
  REQUIRE(parts);
  REQUIRE(parse_transform(parts->content));
  CHECK((*parse_transform(parts->content))[3][2] == 300.125);
}

TEST_CASE("metadata of version 2 holds the status of a transform") {
  const auto messages = read(with_metadata("TransformStatus", "OUT_OF_VIEW"));
  REQUIRE(messages.size() == 1);
  const auto parts = parts_of(messages[0].first, messages[0].second);
  REQUIRE(parts);
  CHECK(parts->content.size() == 48);
  CHECK(metadata_value(*parts, "TransformStatus") == "OUT_OF_VIEW");
  CHECK(metadata_value(*parts, "Transform").empty());
}

TEST_CASE("a message that is cut short brings nothing, and one with any bit of its body or CRC turned nothing either") {
  const Bytes message = make_transform("ProbeToTracker", 5, kPose);
  REQUIRE(read(message).size() == 1);
  for (std::size_t length = 0; length < message.size(); ++length)
    CHECK(read(Bytes(message.begin(), message.begin() + std::ptrdiff_t(length))).empty());
  for (std::size_t bit = 50 * 8; bit < message.size() * 8; ++bit) {
    Bytes turned = message;
    turned[bit / 8] ^= std::uint8_t(1 << (bit % 8));
    CHECK(read(turned).empty());
  }
}

TEST_CASE("bodies that nobody wants or that are too large are passed over, and the next message is read") {
  Bytes stream = make_message("IMAGE", "large", 1, Bytes(MessageReader::kMaxKept + 1, 7));
  for (const Bytes& next : {make_message("POINT", "unwanted", 1, Bytes(99, 1)), make_message("GET_STATUS", "", 0, {}),
                            make_transform("ProbeToTracker", 5, kPose)})
    stream.insert(stream.end(), next.begin(), next.end());
  const auto messages = read(stream);
  REQUIRE(messages.size() == 3);
  CHECK(messages[2].first.type == "TRANSFORM");
  for (const std::size_t portion : {1, 7, 57, 58, 59, 4096}) CHECK(broken_promise(stream, portion) == "");
}

TEST_CASE("what the fuzzer has found keeps the promises too") {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(INSONATE_IGTL_CORPUS_FOLDER)) {
    if (entry.path().filename().string().starts_with(".")) continue;
    const std::string text = read_file(entry.path());
    const Bytes bytes(text.begin(), text.end());
    CAPTURE(entry.path());
    CHECK(broken_promise(ByteView(bytes).subspan(1), 1 + std::size_t(bytes[0])) == "");
    ++count;
  }
  CHECK(count > 50);
}

TEST_CASE("a stream of anything else is distinguished from OpenIGTLink") {
  MessageReader reader([](const Header&) { return true; }, [](const Header&, ByteView) { FAIL("no message"); });
  const std::string web = "HTTP/1.1 400 Bad Request\r\nContent-Type: text/plain; charset=utf-8\r\n\r\n";
  CHECK(reader.feed({reinterpret_cast<const std::uint8_t*>(web.data()), web.size()}) ==
        MessageReader::Damage::not_igtl);
  for (const std::uint64_t size : {MessageReader::kMaxPassed + 1, ~std::uint64_t(0)}) {
    Bytes message = make_transform("ProbeToTracker", 5, kPose);
    for (std::size_t i = 0; i < 8; ++i) message[42 + i] = std::uint8_t(size >> (56 - 8 * i));
    MessageReader fresh([](const Header&) { return true; }, [](const Header&, ByteView) { FAIL("no message"); });
    CHECK(fresh.feed(message) == MessageReader::Damage::not_igtl);
  }
}

TEST_CASE("no bytes break what the reader promises") {
  std::vector<Bytes> seeds = {make_transform("ProbeToTracker", 5, kPose), make_status("", 0, {2, "no"}),
                              make_string("unwanted", 1, "text"), with_metadata("TransformStatus", "OK")};
  Bytes all;
  for (const Bytes& seed : seeds) all.insert(all.end(), seed.begin(), seed.end());
  seeds.push_back(all);
  std::uint32_t drawn = 0;
  const auto random = [&](std::size_t below) { return hash(1, 2, 3, drawn++) % below; };
  for (int round = 0; round < 4000; ++round) {
    Bytes bytes = seeds[random(seeds.size())];
    for (std::size_t changes = random(6); changes-- > 0;)
      bytes[random(bytes.size())] = std::uint8_t(random(2) ? random(256) : random(2) * 255);
    // A CRC that fits lets what was changed through to the parsers.
    if (random(2)) {
      const std::uint64_t crc = crc64(ByteView(bytes).subspan(kHeaderBytes));
      for (std::size_t i = 0; i < 8; ++i) bytes[50 + i] = std::uint8_t(crc >> (56 - 8 * i));
    }
    const std::string broken = broken_promise(bytes, 1 + random(100));
    if (!broken.empty()) FAIL(broken << " in round " << round);
  }
}

}  // namespace insonate::igtl
