// What is not a fan, and what no probe has.

#include "sim/registration/find_fan.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "sim/core/hash.h"
#include "sim/registration/echo_seen.h"

using namespace insonate;

namespace {

constexpr int kWidth = 320, kHeight = 240;

template <typename Inside>
Image<std::uint8_t> mask_of(Inside&& inside) {
  Image<std::uint8_t> mask(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) mask.at(x, y) = inside(x, y);
  return mask;
}

Image<std::uint8_t> fan_of(const Probe& probe, double depth_mm, const glm::dvec2& face, double mm) {
  return mask_of(
      [&](int x, int y) { return line_position(probe, depth_mm, mm * (glm::dvec2(x, y) - face)).has_value(); });
}

}  // namespace

TEST_CASE("a drawn fan is found within a tenth of a pixel, also with pixels that are not square and with shadows") {
  Probe probe = *find_probe("curvilinear");
  probe.radius_mm = 45;
  probe.field_of_view_deg = 72;
  const glm::dvec2 mm(0.7, 0.9), face(150.3, 20.6);
  const Image<std::uint8_t> mask = mask_of([&](int x, int y) {
    const auto at = line_position(probe, 130, mm * (glm::dvec2(x, y) - face));
    // Two shadows, and specks of darkness.
    return at && !(at->line > 30 && at->line < 50 && at->r_mm > 60) && !(at->line > 150 && at->r_mm > 90) &&
           hash(std::uint32_t(x + kWidth * y)) % 8 != 0;
  });
  const FanSearch search = find_fan(mask, mm);
  REQUIRE(search.fan);
  CHECK(search.fan->probe.kind == ProbeKind::curvilinear);
  CHECK(search.fan->probe.radius_mm == Approx(45).margin(0.5));
  CHECK(search.fan->probe.field_of_view_deg == Approx(72).margin(0.5));
  CHECK(search.fan->depth_mm == Approx(130).margin(0.3));
  CHECK(search.fan->face_pixel.x == Approx(face.x).margin(0.2));
  CHECK(search.fan->face_pixel.y == Approx(face.y).margin(0.2));
  CHECK(search.fan->filled < 0.9);
}

TEST_CASE("an image that is full of echo is that of a linear probe") {
  const FanSearch search = find_fan(mask_of([](int, int) { return true; }), glm::dvec2(0.15));
  REQUIRE(search.fan);
  CHECK(search.fan->probe.kind == ProbeKind::linear);
  CHECK(search.fan->probe.width_mm == Approx(0.15 * kWidth).margin(0.1));
  CHECK(search.fan->depth_mm == Approx(0.15 * kHeight).margin(0.1));
  CHECK(search.fan->clip == std::array{0, 0, kWidth, kHeight});
}

TEST_CASE("what is not a fan is refused, and so is one that no probe has") {
  const auto problem = [](const Image<std::uint8_t>& mask, const glm::dvec2& size = glm::dvec2(0.5)) {
    const FanSearch search = find_fan(mask, size);
    CHECK_FALSE(search.fan);
    return search.problem;
  };
  CHECK(problem(mask_of([](int, int) { return false; })) == "its images show no fan: hardly any pixel carries echo");
  CHECK(problem(mask_of([](int x, int y) { return x > 100 && x < 110 && y > 50 && y < 90; })) ==
        "its images show no fan: hardly any pixel carries echo");
  // Two blots, and a ring.
  const auto blot = [](int x, int y, int u, int v) { return std::hypot(x - u, y - v) < 40; };
  CHECK(problem(mask_of([&](int x, int y) { return blot(x, y, 60, 60) || blot(x, y, 250, 190); })) ==
        "its images show no fan: what carries echo has the shape of none");
  CHECK(problem(mask_of([](int x, int y) { return std::abs(std::hypot(x - 160, y - 120) - 90) < 12; })) ==
        "its images show no fan: what carries echo has the shape of none");
  CHECK_THAT(problem(fan_of(*find_probe("linear"), 50, {160, 10}, 0.25), glm::dvec2(0.01)),
             Catch::Contains("has a depth of 2.0 mm, not 20 to 400"));
  CHECK_THAT(problem(fan_of(*find_probe("linear"), 50, {160, 10}, 0.25), glm::dvec2(1.5)),
             Catch::Contains("a face's width of 241") && Catch::Contains("not 5 to 200"));
}

TEST_CASE("echo is what changes, where anything changes") {
  EchoSeen seen;
  for (std::uint32_t n = 0; n < 4; ++n) {
    Image<std::uint8_t> image(kWidth, kHeight, 2);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (x < 150) image.at(x, y) = std::uint8_t(20 + hash(std::uint32_t(x + kWidth * y) + 100000 * n) % 200);
        if (x > 200 && y > 20 && y < 200) image.at(x, y) = 120;  // a logo
        if (x < 150 && y < 10) image.at(x, y) = 255;             // the brightest echo, which is saturated
      }
    seen.add(image);
  }
  const Image<std::uint8_t> mask = seen.mask();
  CHECK(mask.at(100, 100) == 1);
  CHECK(mask.at(100, 3) == 1);
  CHECK(mask.at(220, 100) == 0);
  CHECK_THROWS_AS(seen.add(Image<std::uint8_t>(3, 3)), std::invalid_argument);
}
