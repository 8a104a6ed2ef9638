#include "sim/reconstruction/sweep_quality.h"

#include <catch2/catch.hpp>

#include "tests/reconstruction/swept_scene.h"

using namespace insonate;

namespace {

/// A hand that slides along the elevation to these places, one picture each, and meanwhile along the picture.
std::vector<TrackedPicture> slid(const std::vector<double>& places_mm, const std::vector<double>& times_s,
                                 double along_per_mm = 0) {
  const HandSweep sweep;
  const auto region = rectangle_region(sweep.width, sweep.height, {0, 0, sweep.width, sweep.height});
  std::vector<TrackedPicture> pictures;
  for (std::size_t n = 0; n < places_mm.size(); ++n) {
    TrackedPicture picture;
    picture.region = region;
    const Pose pose = oblique_pose() * Pose{glm::dmat3(1.0), {along_per_mm * places_mm[n], 0, places_mm[n]}};
    picture.patient_from_pixel = patient_from_pixel(pose, sweep.geometry());
    picture.time_s = 50 + times_s[n];
    pictures.push_back(picture);
  }
  return pictures;
}

struct Hand {
  std::vector<double> places_mm{0}, times_s{0};
  void go(int pictures, double step_mm, double step_s = 0.1) {
    for (int n = 0; n < pictures; ++n) {
      places_mm.push_back(places_mm.back() + step_mm);
      times_s.push_back(times_s.back() + step_s);
    }
  }
  SweepQuality quality(const SweepLimits& limits = {1.0, 2.0}) const {
    return sweep_quality(slid(places_mm, times_s), limits);
  }
};

std::vector<std::string> words(const SweepQuality& quality) {
  std::vector<std::string> texts;
  for (const SweepFlaw& flaw : quality.flaws) texts.push_back(flaw.words());
  return texts;
}

}  // namespace

TEST_CASE("an even sweep has its length, duration and speed, and no flaw") {
  Hand hand;
  hand.go(40, 0.8);
  const SweepQuality quality = hand.quality();
  CHECK(quality.pictures == 41);
  CHECK(quality.length_mm == Approx(32));
  CHECK(quality.duration_s == Approx(4));
  CHECK(quality.picture_hz == Approx(10));
  CHECK(quality.largest_spacing_mm == Approx(0.8));
  CHECK(quality.fastest_mm_s == Approx(8));
  CHECK(quality.is_good());
  CHECK(quality.verdict() == "Even: 41 pictures over 32 mm in 4.0 s, at most 0.8 mm apart.");
}

TEST_CASE("a sweep in the direction of -z is as good") {
  Hand hand;
  hand.go(40, -0.8);
  const SweepQuality quality = hand.quality();
  CHECK(quality.length_mm == Approx(32));
  CHECK(quality.is_good());
}

TEST_CASE("a part that is too fast is named by its times") {
  Hand hand;
  hand.go(32, 0.8);
  hand.go(8, 1.7);
  hand.go(20, 0.8);
  const SweepQuality quality = hand.quality();
  CHECK(words(quality) == std::vector<std::string>{"too fast between 3.2 s and 4.0 s"});
  CHECK(quality.flaws[0].size_mm == Approx(1.7));
  CHECK(quality.fastest_mm_s == Approx(17));
  CHECK(quality.verdict() == "Uneven: 61 pictures over 55 mm in 6.0 s, up to 1.7 mm apart.");
}

TEST_CASE("a moment that is too fast has one time") {
  Hand hand;
  hand.go(32, 0.8, 0.01);
  hand.go(1, 1.7, 0.01);
  hand.go(20, 0.8, 0.01);
  CHECK(words(hand.quality()) == std::vector<std::string>{"too fast at 0.3 s"});
}

TEST_CASE("missing pictures are a gap, named by where it lies") {
  Hand hand;
  hand.go(50, 0.8);
  hand.go(1, 1.6, 0.2);  // one picture is missing
  hand.go(10, 0.8);
  hand.go(1, 6.0);  // wider than holes are filled
  hand.go(1, 6.0);
  hand.go(10, 0.8);
  CHECK(words(hand.quality()) ==
        std::vector<std::string>{"gap of 1.6 mm at 40 mm", "gap of 6.0 mm at 50 mm", "gap of 6.0 mm at 56 mm"});
}

TEST_CASE("a gap just before the middle of the sweep lies at 0 mm, not at -0") {
  CHECK(SweepFlaw{SweepFlaw::Kind::gap, 0, 0, -0.3, 7.3}.words() == "gap of 7.3 mm at 0 mm");
}

TEST_CASE("a rest without pictures is not a gap") {
  Hand hand;
  hand.go(20, 0.8);
  hand.go(1, 0.1, 3.0);
  hand.go(20, 0.8);
  CHECK(hand.quality().is_good());
}

TEST_CASE("turning back is named, and tremor is not") {
  Hand hand;
  hand.go(20, 0.8);
  hand.go(5, -0.8);
  hand.go(20, 0.8);
  hand.go(1, -0.3);
  hand.go(10, 0.8);
  CHECK(words(hand.quality()) == std::vector<std::string>{"turned back by 4 mm between 2.0 s and 2.5 s"});
}

TEST_CASE("a tilting probe is measured where its pictures are farthest apart") {
  std::vector<TrackedPicture> pictures;
  const HandSweep sweep;
  const auto region = rectangle_region(sweep.width, sweep.height, {0, 0, sweep.width, sweep.height});
  for (int n = 0; n < 10; ++n) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(double(n)), glm::dvec3(1, 0, 0));
    TrackedPicture picture;
    picture.region = region;
    picture.patient_from_pixel = patient_from_pixel(oblique_pose() * Pose{glm::dmat3(turn), {}}, sweep.geometry());
    picture.time_s = 0.1 * n;
    pictures.push_back(picture);
  }
  const double deepest_mm = 0.5 * 79;
  const SweepQuality quality = sweep_quality(pictures, {1, 2});
  CHECK(quality.largest_spacing_mm == Approx(deepest_mm * std::sin(glm::radians(1.0))));
  CHECK(quality.length_mm == Approx(9 * deepest_mm / 2 * std::sin(glm::radians(1.0))));
  CHECK(quality.is_good());
}

TEST_CASE("fewer than two pictures are not a sweep") {
  CHECK_FALSE(sweep_quality({}, {1, 2}).is_good());
  CHECK_FALSE(Hand().quality().is_good());
  CHECK(Hand().quality().verdict() == "No sweep: it has fewer than two pictures.");
}

TEST_CASE("a sweep along its own picture is not good, and the verdict says to sweep across it") {
  Hand hand;
  hand.go(40, 0.1);
  const SweepQuality along = sweep_quality(slid(hand.places_mm, hand.times_s, 10), {1.0, 2.0});
  CHECK(along.is_along());
  CHECK_FALSE(along.is_good());
  CHECK(along.slid_mm == Approx(40));
  CHECK(along.verdict() == "41 pictures over 4 mm in 4.0 s. They moved 40 mm within their own plane: sweep across it.");
  const SweepQuality askew = sweep_quality(slid(hand.places_mm, hand.times_s, 1), {1.0, 2.0});
  CHECK(askew.is_good());
  CHECK(sweep_quality(
            slid(std::vector<double>(20, 0.0), std::vector<double>(hand.times_s.begin(), hand.times_s.begin() + 20)),
            {1.0, 2.0})
            .is_good());  // a hand at rest does not slide

  std::vector<TrackedPicture> deeper = slid(hand.places_mm, hand.times_s);
  const auto another = rectangle_region(60, 40, {0, 0, 60, 40});  // as of another depth
  for (std::size_t n = 20; n < deeper.size(); ++n) {
    deeper[n].region = another;
    deeper[n].patient_from_pixel = deeper[n].patient_from_pixel * glm::dmat4(glm::dmat3(2.0));
  }
  CHECK(sweep_quality(deeper, {1.0, 2.0}).slid_mm < 1e-6);
}
