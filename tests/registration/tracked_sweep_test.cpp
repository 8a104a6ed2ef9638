// Tests how images become smaller, and what a registration error means.

#include "sim/registration/tracked_sweep.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>

using namespace insonate;

namespace {

TrackedSweep ramps(int count, int width, int height) {
  TrackedSweep sweep{Probe(*find_probe("linear")), 40, {}};
  const ImageGeometry geometry = image_geometry(sweep.probe, sweep.depth_mm, width, height);
  for (int i = 0; i < count; ++i) {
    SweepImage image{Pose{glm::dmat3(1.0), glm::dvec3(0, 0, i)}, Image<float>(width, height)};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::dvec2 at = geometry.plane_mm(x, y);
        image.grey.at(x, y) = float(100 + at.x + 2 * at.y + 1000 * i);
      }
    sweep.images.push_back(std::move(image));
  }
  return sweep;
}

}  // namespace

TEST_CASE("a reduced sweep has evenly spread images, and each keeps its values at their places") {
  const TrackedSweep sweep = ramps(10, 128, 96), small = reduced(sweep, 5, 40, 30);
  REQUIRE(small.images.size() == 5);
  const ImageGeometry geometry = image_geometry(sweep.probe, sweep.depth_mm, 40, 30);
  for (std::size_t i = 0; i < 5; ++i) {
    const SweepImage& image = small.images[i];
    CHECK(image.sweep_from_probe.translation.z == double(2 * i + 1));
    for (int y = 3; y < 27; ++y)
      for (int x = 3; x < 37; ++x) {
        const glm::dvec2 at = geometry.plane_mm(x, y);
        // The weights of single pixels are off the ramp's middle by a fraction of a pixel of 0.4 mm.
        CHECK(image.grey.at(x, y) == Approx(100 + at.x + 2 * at.y + 1000 * double(2 * i + 1)).margin(0.15));
      }
  }
  CHECK(reduced(sweep, 20, 128, 96).images.size() == 10);
  CHECK(reduced(sweep, 20, 128, 96).images[3].grey.pixels == sweep.images[3].grey.pixels);
}

TEST_CASE("unknown pixels stay unknown where most of a pixel is") {
  TrackedSweep sweep = ramps(1, 128, 96);
  for (int y = 0; y < 96; ++y)
    for (int x = 64; x < 128; ++x) sweep.images[0].grey.at(x, y) = std::numeric_limits<float>::quiet_NaN();
  const Image<float> small = reduced(sweep, 1, 64, 48).images[0].grey;
  CHECK(std::isnan(small.at(40, 20)));
  CHECK_FALSE(std::isnan(small.at(30, 20)));
}

TEST_CASE("the target error of a shift is its length, and that of a turn grows with the distance") {
  const TrackedSweep sweep = ramps(3, 64, 48);
  const std::vector<glm::dvec3> points = target_points(sweep);
  REQUIRE(points.size() == 75);
  double farthest = 0;
  for (const glm::dvec3& point : points) farthest = std::max(farthest, point.y);
  CHECK(farthest == Approx(36));  // the middle of the last of five parts of 40 mm
  const glm::dmat4 one(1.0), shift = glm::translate(one, glm::dvec3(3, 0, 4));
  CHECK(target_error_mm(points, one, shift) == Approx(5));
  const glm::dmat4 turn = glm::rotate(one, 0.1, glm::dvec3(1, 0, 0));
  double squares = 0;
  for (const glm::dvec3& p : points) squares += std::pow(2 * std::sin(0.05), 2) * (p.y * p.y + p.z * p.z);
  CHECK(target_error_mm(points, one, turn) == Approx(std::sqrt(squares / 75)));
}

TEST_CASE("the moments of points tell how far two close maps move them, far from the origin too") {
  std::vector<glm::dvec3> points = target_points(ramps(3, 64, 48));
  for (glm::dvec3& point : points) point += glm::dvec3(900, -700, 1200);  // such as in a tracker's frame
  const glm::dmat4 moments = moments_of(points);
  const glm::dvec3 middle = points[37];
  for (const double radians : {1e-4, 0.1}) {
    const glm::dmat4 one = glm::translate(glm::dmat4(1.0), glm::dvec3(20, 30, 40)),
                     other = one * glm::translate(glm::dmat4(1.0), middle + glm::dvec3(1e-3, 0, 0)) *
                             glm::rotate(glm::dmat4(1.0), radians, glm::dvec3(0, 0, 1)) *
                             glm::translate(glm::dmat4(1.0), -middle);
    double squares = 0;
    for (const glm::dvec3& p : points) {
      const glm::dvec4 apart = one * glm::dvec4(p, 1) - other * glm::dvec4(p, 1);
      squares += glm::dot(apart, apart);
    }
    // Sums of squares of some 1e6 mm2 differ by their rounding, which is 1e-9 mm2; the least distance is some 1e-3 mm.
    CHECK(target_error_mm(moments, one, other) == Approx(std::sqrt(squares / 75)).epsilon(1e-3));
  }
}

TEST_CASE("an image varies in depth by what lies there, not by the probe's ringing or noise") {
  Image<float> in_air(40, 50), tissue(40, 50);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 40; ++x) {
      in_air.at(x, y) = y < 10 ? 255.0F : y >= 30 ? float(60 * (x % 2)) : 0.0F;
      tissue.at(x, y) = x % 2 == 0 ? 30.0F : 34.0F;
    }
  tissue.at(7, 20) = std::numeric_limits<float>::quiet_NaN();
  CHECK(variation_in_depth(in_air) == 0);
  // 20 rows of 40 pixels, all but one known, each 2 from the mean of 32 but for the missing one's share.
  CHECK(variation_in_depth(tissue) == Approx(4 * 799 - 4.0 / 799));
}
