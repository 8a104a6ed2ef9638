// Images over OpenIGTLink: as Debian's library and this project write them, and what cannot be used.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <igtlImageMessage.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <variant>

#include "devices/igtl/igtl_message.h"
#include "devices/igtl/igtl_reader.h"

namespace insonate::igtl {
namespace {

constexpr int kWidth = 7, kHeight = 5;
const Pose kPose{glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)))), {12.5, -40.25, 300.125}};

ReceivedImage image_of(const Bytes& message) {
  auto parsed = parse_image(ByteView(message).subspan(kHeaderBytes));
  if (const auto* problem = std::get_if<std::string>(&parsed)) FAIL(*problem);
  return std::get<ReceivedImage>(std::move(parsed));
}

std::string problem_of(const Bytes& message) {
  const auto parsed = parse_image(ByteView(message).subspan(kHeaderBytes));
  const auto* problem = std::get_if<std::string>(&parsed);
  return problem ? *problem : "none";
}

/// Returns a message that Debian's library writes, of a type and with what `value` gives for each component.
template <typename T, typename Value>
Bytes theirs(int type, int components, Value&& value, int endian = ::igtl::ImageMessage::ENDIAN_BIG) {
  auto image = ::igtl::ImageMessage::New();
  image->SetDimensions(kWidth, kHeight, 1);
  image->SetSpacing(0.25f, 0.5f, 1);
  image->SetScalarType(type);
  image->SetNumComponents(components);
  image->SetEndian(endian);
  ::igtl::Matrix4x4 place;
  ::igtl::IdentityMatrix(place);
  place[0][3] = 10;
  image->SetMatrix(place);
  image->AllocateScalars();
  auto* bytes = static_cast<std::uint8_t*>(image->GetScalarPointer());
  for (int i = 0; i < kWidth * kHeight * components; ++i) {
    const T each = value(i);
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, &each, sizeof(T));
    for (std::size_t b = 0; b < sizeof(T); ++b)
      *bytes++ = raw[endian == ::igtl::ImageMessage::ENDIAN_BIG ? sizeof(T) - 1 - b : b];
  }
  image->Pack();
  const auto* begin = static_cast<const std::uint8_t*>(image->GetPackPointer());
  return Bytes(begin, begin + image->GetPackSize());
}

}  // namespace

TEST_CASE("an image of our own comes back with its place") {
  Image<std::uint8_t> picture(kWidth, kHeight);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = std::uint8_t(7 * i);
  const ReceivedImage image = image_of(make_image("Ultrasound", 1, picture, kPose, 0.25));
  CHECK(image.grey.pixels == picture.pixels);
  CHECK(image.grey.width == kWidth);
  // The middle of the image is at the pose, within the message's single precision.
  const glm::dvec4 middle = image.frame_from_pixel * glm::dvec4((kWidth - 1) / 2.0, (kHeight - 1) / 2.0, 0, 1);
  CHECK(glm::distance(glm::dvec3(middle), kPose.translation) < 1e-4);
  CHECK(glm::distance(glm::dvec3(image.frame_from_pixel[0]), 0.25 * kPose.rotation[0]) < 1e-6);
}

TEST_CASE("images of every type that Debian's library writes are read") {
  using Message = ::igtl::ImageMessage;
  const auto grey = [](const Bytes& message, int i) { return int(image_of(message).grey.pixels[std::size_t(i)]); };
  const auto ramp = [](int i) { return i; };
  const Bytes bytes = theirs<std::uint8_t>(Message::TYPE_UINT8, 1, ramp);
  CHECK(grey(bytes, 9) == 9);
  const glm::dmat4 place = image_of(bytes).frame_from_pixel;
  CHECK(place[0].x == Approx(0.25));
  CHECK(place[1].y == Approx(0.5));
  CHECK(place[3].x == Approx(10 - 0.25 * (kWidth - 1) / 2));
  // The largest value, 34, becomes white.
  CHECK(grey(theirs<std::uint16_t>(Message::TYPE_UINT16, 1, [](int i) { return std::uint16_t(1000 * i); }), 17) == 128);
  CHECK(grey(theirs<std::int16_t>(Message::TYPE_INT16, 1, [](int i) { return std::int16_t(17 - i); }), 34) == 0);
  CHECK(grey(theirs<std::uint16_t>(
                 Message::TYPE_UINT16, 1, [](int i) { return std::uint16_t(1000 * i); }, Message::ENDIAN_LITTLE),
             17) == 128);
  CHECK(grey(theirs<float>(Message::TYPE_FLOAT32, 1, [](int i) { return i == 3 ? NAN : 0.5f * float(i); }), 17) == 128);
  CHECK(grey(theirs<float>(Message::TYPE_FLOAT32, 1, [](int i) { return i == 3 ? NAN : 0.5f * float(i); }), 3) == 0);
  CHECK(grey(theirs<double>(Message::TYPE_FLOAT64, 1, [](int i) { return 1e200 * i; }), 17) == 128);
  // Red alone: 0.299 of 200.
  CHECK(grey(theirs<std::uint8_t>(Message::TYPE_UINT8, 3, [](int i) { return i % 3 == 0 ? 200 : 0; }), 5) == 60);
}

TEST_CASE("an image that cannot be used is refused in words") {
  const Bytes good = make_image("Ultrasound", 1, Image<std::uint8_t>(kWidth, kHeight), kPose, 0.25);
  const auto with = [&](std::size_t at, int value) {
    Bytes changed = good;
    changed[kHeaderBytes + at] = std::uint8_t(value);
    return problem_of(changed);
  };
  CHECK(problem_of(good) == "none");
  CHECK(with(2, 2) == "has 2 components per pixel, not 1, 3 or 4");
  CHECK(with(3, 9) == "has pixels of the unknown type 9");
  CHECK(with(3, 5) == "has 35 bytes for 7 x 5 x 1 pixels of 2");
  CHECK(with(7, 200) == "holds only 7 x 5 x 1 of its 200 x 5 x 1 pixels");
  CHECK(with(11, 3) == "has 3 slices, not one");
  CHECK(with(9, 1) == "has 7 x 1 x 1 pixels");
  CHECK(with(61, 1) == "holds only 7 x 5 x 1 of its 7 x 5 x 1 pixels");
  for (std::size_t length = 0; length < good.size() - kHeaderBytes; ++length) {
    const auto parsed = parse_image(ByteView(good).subspan(kHeaderBytes, length));
    CHECK(std::holds_alternative<std::string>(parsed));
  }
}

TEST_CASE("a reader that is made for images stores up to its bound, and passes over what is larger") {
  std::size_t stored = 0;
  const auto read = [&](std::size_t bytes, std::uint64_t bound) {
    stored = 0;
    MessageReader reader([](const Header&) { return true; },
                         [&](const Header&, ByteView body) { stored = body.size(); }, bound);
    CHECK(reader.feed(make_message("IMAGE", "Ultrasound", 1, Bytes(bytes, 7))) == MessageReader::Damage::none);
    return stored;
  };
  CHECK(read(100000, MessageReader::kMaxKept) == 0);
  CHECK(read(100000, MessageReader::kMaxKeptWithImages) == 100000);
  CHECK(read(MessageReader::kMaxKeptWithImages, MessageReader::kMaxKeptWithImages) ==
        MessageReader::kMaxKeptWithImages);
  CHECK(read(MessageReader::kMaxKeptWithImages + 1, MessageReader::kMaxKeptWithImages) == 0);
}

}  // namespace insonate::igtl
