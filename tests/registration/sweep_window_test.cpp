// Tests which images of a moving probe are registered.

#include "sim/registration/sweep_window.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace insonate;

namespace {

SweepImage at(double z_mm, float grey = 0) {
  return {Pose{glm::dmat3(1.0), glm::dvec3(0, 0, z_mm)}, Image<float>(8, 8, grey)};
}

SweepWindow window() {
  return {*find_probe("linear"), 50};
}

}  // namespace

TEST_CASE("a probe that rests keeps one image, the newest") {
  SweepWindow images = window();
  for (int i = 0; i < 50; ++i) images.add(at(0.5 * SweepWindow::kMinApart_mm * (i % 2), float(i)));
  CHECK(images.size() == 1);
  CHECK(images.chosen(5).images.front().grey.at(0, 0) == 49);
  CHECK(images.version() == 50);
  images.clear();
  CHECK(images.size() == 0);
  CHECK(images.version() == 51);
}

TEST_CASE("the newest image and the farthest ones are chosen, and old ones are forgotten") {
  SweepWindow images = window();
  const int all = int(SweepWindow::kKept) + 30;
  for (int i = 0; i < all; ++i) images.add(at(2.0 * i));
  CHECK(images.size() == SweepWindow::kKept);
  const TrackedSweep sweep = images.chosen(5);
  REQUIRE(sweep.images.size() == 5);
  const auto z = [&](std::size_t i) { return sweep.images[i].sweep_from_probe.translation.z; };
  CHECK(z(0) == 2.0 * (all - 1));
  CHECK(z(1) == 2.0 * 30);
  // Then the middle, and the middles of both halves.
  CHECK(z(2) == Approx((z(0) + z(1)) / 2).margin(1.01));
  CHECK(std::abs(z(3) - z(4)) == Approx((z(0) - z(1)) / 2).margin(3));
  CHECK(spread_mm(sweep) == Approx(z(0) - z(1)));
}

TEST_CASE("an image is chosen once, however many are asked for") {
  SweepWindow images = window();
  for (const double z : {0.0, 3.0, 9.0}) images.add(at(z));
  const TrackedSweep sweep = images.chosen(20);
  REQUIRE(sweep.images.size() == 3);
  CHECK(sweep.images[0].sweep_from_probe.translation.z == 9);
  CHECK(sweep.images[1].sweep_from_probe.translation.z == 0);
  CHECK(sweep.images[2].sweep_from_probe.translation.z == 3);
}
