#include "devices/calibration/axes.h"

#include <catch2/catch.hpp>

#include "devices/calibration/tip.h"
#include "tests/devices/calibration/synthetic.h"

using namespace insonate;

namespace {

/// The moves as a hand makes them over a patient on the back (LPS), seen by a tracker whose base and sensor are placed
/// at will; `clumsy_deg` of play in each hold and each direction.
AxesMoves made_by_hand(Dice& dice, const Pose& base, const Pose& mount, double clumsy_deg) {
  const auto play = [&] {
    const double deg = dice.uniform(0, clumsy_deg);
    return turned(deg, dice.point(1));
  };
  // Probe frames: +x to the marker, +y into the body.
  const glm::dvec3 right(-1, 0, 0), up(0, -1, 0), head(0, 0, 1);
  const auto held = [](const glm::dvec3& marker, const glm::dvec3& beam) {
    return Pose{glm::dmat3(marker, beam, glm::cross(marker, beam)), {0, -150, 0}};
  };
  const auto move = [&](Pose patient_from_probe, const glm::dvec3& way) {
    patient_from_probe.rotation = play().rotation * patient_from_probe.rotation;
    Pose end = patient_from_probe;
    end.rotation = turned(dice.uniform(0, 5), dice.point(1)).rotation * end.rotation;
    end.translation += play().rotation * (way * dice.uniform(90, 200));
    return StraightMove{base * patient_from_probe * mount, base * end * mount};
  };
  const Pose upright = held(right, -up);
  return {move(upright, right), move(upright, up), move(held(head, -up), head), move(held(up, right), up)};
}

/// What a tracker with these signs wrong says.
AxesMoves seen_by(const AxisSigns& wrong, const AxesMoves& moves) {
  const auto seen = [&](const StraightMove& move) {
    return StraightMove{wrong.apply(move.from), wrong.apply(move.to)};
  };
  return {seen(moves.right), seen(moves.up), seen(moves.to_head), seen(moves.lying)};
}

}  // namespace

TEST_CASE("a right tracker passes, however its base and sensor are placed and a hand is clumsy") {
  Dice dice(1);
  for (int run = 0; run < 100; ++run) {
    const auto finding = check_axes(made_by_hand(dice, dice.pose(500), dice.pose(100), 8));
    REQUIRE(finding);
    CHECK(finding->signs.none());
    CHECK(finding->misfit_deg < 25);
  }
}

TEST_CASE("mirrored axes are found, and what is found makes the probe pivot") {
  Dice dice(2);
  std::vector<AxisSigns> wrongs;
  for (const glm::dvec3& position :
       {glm::dvec3(1), glm::dvec3(-1, 1, 1), glm::dvec3(1, -1, 1), glm::dvec3(1, 1, -1), glm::dvec3(-1)})
    for (int bits = 0; bits < 8; ++bits)
      wrongs.push_back({position, {bits & 1 ? -1 : 1, bits & 2 ? -1 : 1, bits & 4 ? -1 : 1}});
  int confused = 0;
  for (const AxisSigns& wrong : wrongs) {
    for (int run = 0; run < 25; ++run) {
      const Pose base = dice.pose(500), mount = dice.pose(100);
      const auto finding = check_axes(seen_by(wrong, made_by_hand(dice, base, mount, 4)));
      CAPTURE(wrong.words(), run);
      REQUIRE(finding);
      // Signs may be undone by others that differ by a turn of the base only; then the probe pivots all the same.
      const glm::dvec3 tip(3, 5, 120), pivot(40, 60, -90);
      std::vector<Pose> poses;
      for (const Pose& pose : pivoting(dice, dice.pose(1), tip, pivot, 40, 90, 300, 0.1))
        poses.push_back(finding->signs.apply(wrong.apply(pose)));
      const auto fit = fit_tip(poses);
      CAPTURE(finding->signs.words());
      if (!fit)
        ++confused;
      else
        CHECK(fit->residual_mm < 0.3);
    }
  }
  // Some placements of base and sensor make two readings look alike to a hand that is 4 degrees off: 24 of 16,000 did.
  // Nothing pivots by the wrong one, so that the next step refuses it.
  CHECK(confused <= 10);
}

TEST_CASE("a single mirrored axis of the position is named, and so is the quaternion's y and z") {
  Dice dice(3);
  for (const AxisSigns& wrong :
       {AxisSigns{{-1, 1, 1}, {1, 1, 1}}, AxisSigns{{1, 1, -1}, {1, 1, 1}}, AxisSigns{{1, 1, 1}, {1, -1, -1}}}) {
    const auto finding = check_axes(seen_by(wrong, made_by_hand(dice, dice.pose(500), dice.pose(100), 3)));
    REQUIRE(finding);
    CHECK(finding->signs.position == wrong.position);
    CHECK(finding->signs.quaternion == wrong.quaternion);
    CHECK_FALSE(finding->signs.none());
  }
  CHECK(AxisSigns{}.words() == "no axis is mirrored");
  CHECK(AxisSigns{{-1, 1, 1}, {1, -1, -1}}.words() == "mirrored: the position's x; the quaternion's y and z");
}

TEST_CASE("moves that say nothing are refused") {
  using Catch::Contains;
  Dice dice(4);
  AxesMoves moves = made_by_hand(dice, Pose{}, Pose{}, 2);
  moves.up.to = moves.up.from;
  CHECK_THAT(check_axes(moves).refusal(), Contains("The move up was 0 mm long"));
  moves = made_by_hand(dice, Pose{}, Pose{}, 2);
  moves.to_head = moves.right;
  CHECK_THAT(check_axes(moves).refusal(), Contains("not at right angles"));
  // The probe held all the time as at first.
  moves = made_by_hand(dice, Pose{}, Pose{}, 2);
  for (StraightMove* move : {&moves.to_head, &moves.lying}) move->from.rotation = moves.right.from.rotation;
  CHECK_THAT(check_axes(moves).refusal(), Contains("whatever axis is mirrored"));
}
