#include <catch2/catch.hpp>

#include <array>
#include <vector>

#include "sim/gl/readback.h"
#include "tests/gl/test_context.h"

using namespace insonate;

namespace {

constexpr int kWidth = 5, kHeight = 3;  // rows whose size is not a multiple of four bytes

/// Fills the texture: red counts up from `first`, the other channels have other values.
void fill(gl::Texture& texture, int first) {
  std::vector<std::array<std::uint8_t, 4>> pixels(kWidth * kHeight);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = {std::uint8_t(first + int(i)), 200, 201, 202};
  texture.write(GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

}  // namespace

TEST_CASE("pictures are read back in the order they were asked for, each as it was then") {
  const test::TestContext context;
  gl::Texture texture = gl::Texture::make_2d(GL_RGBA8, kWidth, kHeight, gl::Filter::nearest);
  gl::Readback readback;
  CHECK_FALSE(readback.take());
  CHECK_FALSE(readback.take(true));
  for (const int first : {10, 50, 90}) {
    fill(texture, first);
    CHECK_FALSE(readback.full());
    readback.begin(texture);
  }
  CHECK(readback.full());
  CHECK_THROWS_AS(readback.begin(texture), std::logic_error);
  fill(texture, 0);

  const auto waited = readback.take(true);
  REQUIRE(waited);
  CHECK(waited->width == kWidth);
  CHECK(waited->at(0, 0) == 10);
  CHECK(waited->at(4, 2) == 24);
  glFinish();
  INFO("what is done is there without waiting");
  const auto next = readback.take();
  REQUIRE(next);
  CHECK(next->at(1, 1) == 56);

  readback.forget();
  CHECK_FALSE(readback.take(true));
  CHECK(glGetError() == GL_NO_ERROR);
}
