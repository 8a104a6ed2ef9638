#include "devices/calibration/tip.h"

#include <catch2/catch.hpp>

#include "tests/devices/calibration/synthetic.h"

using namespace insonate;

namespace {

const glm::dvec3 kTip(12, -7, 148), kPivot(230, -110, 64);

std::vector<Pose> pivoting_well(Dice& dice, double noise_mm, int count = 600) {
  return pivoting(dice, dice.pose(1), kTip, kPivot, 35, 60, count, noise_mm);
}

}  // namespace

TEST_CASE("the tip of a probe that pivots without noise is found to rounding error") {
  Dice dice(1);
  const auto fit = fit_tip(pivoting_well(dice, 0));
  REQUIRE(fit);
  // Positions of 300 mm in double precision, through a 3x3 system of condition 100.
  CHECK(glm::distance(fit->tip_mm, kTip) < 1e-9);
  CHECK(glm::distance(fit->pivot_mm, kPivot) < 1e-9);
  CHECK(fit->residual_mm < 1e-9);
  CHECK(fit->rejected == 0);
}

TEST_CASE("noise moves the tip by what the fit says, and the residual is the noise") {
  constexpr double kNoise_mm = 0.3;  // along each axis
  constexpr int kRuns = 60;
  double squares = 0, reported = 0, residual = 0;
  for (int run = 0; run < kRuns; ++run) {
    Dice dice(std::uint32_t(100 + run));
    const auto fit = fit_tip(pivoting_well(dice, kNoise_mm));
    REQUIRE(fit);
    squares += std::pow(glm::distance(fit->tip_mm, kTip), 2) / kRuns;
    reported += fit->tip_sd_mm / kRuns;
    residual += fit->residual_mm / kRuns;
  }
  // The worst direction's deviation is reported; of three directions the RMS error is 1 to sqrt(3) times as much.
  CHECK(std::sqrt(squares) > 0.9 * reported);
  CHECK(std::sqrt(squares) < 1.1 * std::sqrt(3.0) * reported);
  CHECK(std::sqrt(squares) < 0.06);
  // RMS length of a noise of 0.3 mm an axis is 0.52; the cut at 99 % takes 4 % off.
  CHECK(residual == Approx(std::sqrt(3.0) * kNoise_mm).epsilon(0.06));
}

TEST_CASE("a third of the poses may be anything, and the tip stays") {
  Dice dice(3);
  std::vector<Pose> poses = pivoting_well(dice, 0.2, 900);
  for (std::size_t i = 0; i < poses.size(); i += 3) {
    // Half a hemisphere's jump, half a steel table's pull that is the same every time.
    if (i % 2)
      poses[i].translation = -poses[i].translation;
    else
      poses[i].translation += glm::dvec3(0, 25, 40);
  }
  const auto fit = fit_tip(poses);
  REQUIRE(fit);
  CHECK(glm::distance(fit->tip_mm, kTip) < 0.15);
  CHECK(fit->rejected >= 300);
  CHECK(fit->rejected < 330);
}

TEST_CASE("where the tracker's base stands and how its axes run does not matter to the tip") {
  Dice dice(4);
  const std::vector<Pose> poses = pivoting_well(dice, 0.2);
  const auto fit = fit_tip(poses);
  REQUIRE(fit);
  for (int run = 0; run < 10; ++run) {
    const Pose base = dice.pose(1000), mount = dice.pose(200);
    std::vector<Pose> moved;
    for (const Pose& pose : poses) moved.push_back(base * pose * mount);
    const auto again = fit_tip(moved);
    REQUIRE(again);
    CHECK(glm::distance(again->pivot_mm, base.point(fit->pivot_mm)) < 1e-6);
    CHECK(glm::distance(mount.point(again->tip_mm), fit->tip_mm) < 1e-6);
    CHECK(again->residual_mm == Approx(fit->residual_mm));
    CHECK(again->spread_deg == Approx(fit->spread_deg));
  }
}

TEST_CASE("pivoting that does not determine the tip is refused, and says why") {
  Dice dice(5);
  const Pose start = dice.pose(1);
  const auto refusal = [](const std::vector<Pose>& poses) {
    const auto fit = fit_tip(poses);
    REQUIRE_FALSE(fit);
    return fit.refusal();
  };
  using Catch::Contains;
  CHECK_THAT(refusal({}), Contains("Only 0 poses"));
  CHECK_THAT(refusal(pivoting(dice, start, kTip, kPivot, 35, 60, 49, 0.1)), Contains("Only 49 poses"));
  // Not moved; tilted by too little; only rolled about the length; only tilted about one axis.
  CHECK_THAT(refusal(std::vector<Pose>(300, dice.pose(100))),
             Contains("turned by 0 % of what is needed; tilt it by 30 degrees"));
  CHECK_THAT(refusal(pivoting(dice, start, kTip, kPivot, 8, 4, 300, 0.1)), Contains("turned by"));
  CHECK_THAT(refusal(pivoting(dice, start, kTip, kPivot, 0, 180, 300, 0.1)), Contains("turned by"));
  std::vector<Pose> hinged;
  for (int i = 0; i < 300; ++i) {
    Pose pose = start * turned(dice.uniform(-60, 60), {1, 0.3, 0});
    pose.translation = kPivot - pose.rotation * kTip + dice.noise(0.1);
    hinged.push_back(pose);
  }
  CHECK_THAT(refusal(hinged), Contains("turned by"));
  // A tip that slides about, and a probe that is waved through the air.
  CHECK_THAT(refusal(pivoting(dice, start, kTip, kPivot, 35, 60, 600, 4)), Contains("strayed by"));
  std::vector<Pose> waved;
  for (int i = 0; i < 600; ++i) waved.push_back(dice.pose(200));
  CHECK_FALSE(fit_tip(waved));
}
