#include <catch2/catch.hpp>

#include "devices/calibration/steps/setup_step.h"
#include "tests/devices/calibration/hand.h"

using namespace insonate;
using Catch::Contains;

namespace {

LandmarkList patient() {
  return read_landmark_list(std::string(INSONATE_ASSETS_FOLDER) + "/calibration/abdomen.toml");
}

/// Feeds samples until the step is done; the index of the next one.
std::size_t make(SetupStep& step, const std::vector<SensorSample>& samples, std::size_t from = 0) {
  while (from < samples.size() && !step.view().done) step.feed(samples[from++]);
  return from;
}

/// The whole set-up as a hand makes it in a lab.
Calibration set_up(const Lab& lab, const SetupInput& given, double touch_error_mm) {
  Hand hand(lab, 7);
  hand.axes();
  hand.pivot(14);
  if (!given.drawing) hand.face();
  hand.landmarks(given.landmarks->landmarks, touch_error_mm);
  hand.knocks(0.05);
  Calibration calibration;
  calibration.tracker = {"hydra", "1"};
  std::size_t at = 0;
  for (const std::string_view name : kSetupSteps) {
    CAPTURE(name);
    REQUIRE(why_not_yet(name, calibration, given).empty());
    const auto step = begin_setup_step(name, calibration, given);
    at = make(*step, hand.samples(), at);
    CAPTURE(step->view().task, step->view().refusal);
    REQUIRE(step->view().done);
    CHECK_FALSE(step->view().result.empty());
    CHECK(step->view().share == 1);
    step->store(calibration, 1000);
  }
  return calibration;
}

/// How far a calibration puts the probe elsewhere, at worst over poses at the body: at the face and 100 mm into it.
double worst_error_mm(const Lab& lab, const Calibration& calibration) {
  Dice dice(99);
  double worst = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose ct_from_face = dice.pose(120);
    const Pose raw = lab.wrong.apply(lab.ct_from_tracker.inverse() * ct_from_face * lab.sensor_from_face.inverse());
    const Pose found = calibration.patient_from_probe(raw);
    for (const glm::dvec3& point : {glm::dvec3(0), glm::dvec3(0, 100, 0)})
      worst = std::max(worst, glm::distance(found.point(point), ct_from_face.point(point)));
  }
  return worst;
}

}  // namespace

TEST_CASE("a set-up made with buttons puts the probe where it is in the patient") {
  const Lab lab;
  const Calibration calibration = set_up(lab, {.landmarks = patient()}, 0);
  CHECK(why_incomplete(calibration).empty());
  CHECK(calibration.axes->value.signs.none());
  CHECK(calibration.mannequin->value.accuracy_mm < 0.5);
  CHECK(calibration.mannequin->value.patient == "Abdomen phantom");
  // 30 readings of 0.1 mm leave 0.02 mm of each touched point, and the tip's error comes on top; over the handle's
  // 150 mm and 100 mm into the body that stays below
  CHECK(worst_error_mm(lab, calibration) < 0.5);
  CHECK(calibration.lag->value.lag_s == Approx(0.05).margin(0.01));
}

TEST_CASE("a tracker with mirrored axes is put right on the way") {
  for (const AxisSigns& wrong : {AxisSigns{{1, 1, -1}, {1, 1, 1}}, AxisSigns{{1, 1, 1}, {1, -1, -1}}}) {
    Lab lab;
    lab.wrong = wrong;
    const Calibration calibration = set_up(lab, {.landmarks = patient()}, 0);
    CHECK_FALSE(calibration.axes->value.signs.none());
    CHECK(worst_error_mm(lab, calibration) < 0.5);
  }
}

TEST_CASE("landmarks touched to 2 mm: the accuracy reported is that of the check") {
  const Lab lab;
  const Calibration calibration = set_up(lab, {.landmarks = patient()}, 2 / std::sqrt(3.0));
  CHECK(calibration.mannequin->value.accuracy_mm > 0.3);
  CHECK(calibration.mannequin->value.accuracy_mm < 6);  // three times its RMS, sqrt(0.9^2 + 2^2)
  CHECK(worst_error_mm(lab, calibration) < 5);
}

TEST_CASE("with the probe's drawing the face is not touched, and the tip that was found moves it") {
  const Lab lab;
  // The sensor is glued in 4 mm off.
  const glm::dvec3 off(0, 4, 0);
  ProbeDrawing drawing{"convex dummy", {}, lab.sensor_from_face.point(lab.tip) + off};
  const std::pair<glm::dvec3 FacePoints::*, glm::dvec3> points[] = {{&FacePoints::middle, lab.face.middle},
                                                                    {&FacePoints::marker_end, lab.face.marker_end},
                                                                    {&FacePoints::other_end, lab.face.other_end},
                                                                    {&FacePoints::tail, lab.face.tail}};
  for (const auto& [which, point] : points) drawing.face.*which = lab.sensor_from_face.point(point) + off;
  SetupInput given{.landmarks = patient(), .drawing = drawing};
  const Calibration calibration = set_up(lab, given, 0);
  CHECK(calibration.face->value.method == "drawing");
  CHECK(calibration.face->value.tip_off_mm == Approx(4).margin(0.1));
  CHECK(worst_error_mm(lab, calibration) < 0.5);

  given.drawing->tip_mm = *drawing.tip_mm + glm::dvec3(0, 10, 0);
  const auto refused = begin_setup_step("face", calibration, given);
  CHECK_FALSE(refused->view().done);
  CHECK_THAT(refused->view().refusal, Contains("14 mm from where the drawing has it"));
}

TEST_CASE("when the base was moved the old landmarks are found again, and nothing else changes") {
  Lab lab;
  SetupInput given{.landmarks = patient()};
  Calibration calibration = set_up(lab, given, 1);
  const double before = worst_error_mm(lab, calibration);
  const Pose ct_from_mannequin = calibration.mannequin->value.ct_from_mannequin;
  const Pose ct_from_old = lab.ct_from_tracker;
  lab.ct_from_tracker = {turned(-70, {3, 1, 0}).rotation, {-200, 100, 400}};
  CHECK(worst_error_mm(lab, calibration) > 100);
  given.moved = true;
  const auto step = begin_setup_step("landmarks", calibration, given);
  Hand hand(lab, 8);
  // The places that were touched the last time, not those of the CT.
  std::vector<LandmarkPair> places = calibration.mannequin->value.landmarks;
  for (LandmarkPair& place : places) place.ct_mm = ct_from_old.point(place.touched_mm);
  hand.landmarks(places, 0);
  make(*step, hand.samples());
  REQUIRE(step->view().done);
  step->store(calibration, 2000);
  CHECK(calibration.mannequin->value.ct_from_mannequin == ct_from_mannequin);
  CHECK(worst_error_mm(lab, calibration) == Approx(before).margin(0.5));
  CHECK(calibration.mannequin->value.accuracy_mm < 0.5);
}

TEST_CASE("a hand that slips is asked again, and takes a touch back") {
  const Lab lab;
  Calibration base;
  const SetupInput given{.landmarks = patient()};
  CHECK_THAT(why_not_yet("face", base, given), Contains("Probe tip ('pivot') first"));
  CHECK_THAT(why_not_yet("landmarks", base, given), Contains("Probe tip ('pivot') first"));

  const auto pivot = begin_setup_step("pivot", base, given);
  Hand clumsy(lab, 3);
  clumsy.pivot(14, 5);
  make(*pivot, clumsy.samples());
  CHECK_FALSE(pivot->view().done);
  CHECK_THAT(pivot->view().refusal, Contains("strayed"));
  Hand careful(lab, 4);
  careful.pivot(14);
  make(*pivot, careful.samples());
  REQUIRE(pivot->view().done);
  CHECK(pivot->view().refusal.empty());
  pivot->store(base, 1);

  const auto touch = begin_setup_step("landmarks", base, given);
  CHECK_THAT(touch->view().task, Contains("1 of 9: Touch the lower tip of the breastbone"));
  Hand hand(lab, 5);
  for (int i = 0; i < 40; ++i) hand.hold(Pose{glm::dmat3(1), {double(i), 0, 0}}, 0.02, i == 0);
  make(*touch, hand.samples());
  CHECK_THAT(touch->view().refusal, Contains("moved by"));
  CHECK_THAT(touch->view().task, Contains("1 of 9"));
  Hand again(lab, 6);
  again.hold(Pose{glm::dmat3(1), {5, 5, 5}}, 1, true);
  make(*touch, again.samples());
  CHECK_THAT(touch->view().task, Contains("2 of 9"));
  CHECK(touch->view().refusal.empty());
  touch->undo();
  CHECK_THAT(touch->view().task, Contains("1 of 9"));

  // A key marks as a button does; where the tracker sees nothing there is nothing to read.
  touch->mark(100);
  CHECK(touch->view().reading);
  for (int i = 0; i < 60; ++i) touch->feed({100 + i / 60.0, PoseStatus::out_of_view, {}, 0});
  CHECK_THAT(touch->view().refusal, Contains("not seen long enough"));
}

TEST_CASE("other axes than before make what was measured with them worthless, the same ones do not") {
  Lab lab;
  Calibration calibration = set_up(lab, {.landmarks = patient()}, 0);
  const auto check = [&] {
    const auto step = begin_setup_step("axes", calibration, {});
    Hand hand(lab, 9);
    hand.axes();
    make(*step, hand.samples());
    REQUIRE(step->view().done);
    step->store(calibration, 3);
  };
  check();
  CHECK(why_incomplete(calibration).empty());
  lab.wrong.quaternion = {1, -1, -1};
  check();
  CHECK_FALSE(calibration.tip);
  CHECK(why_incomplete(calibration) == "face");
}

TEST_CASE("a button that is held over a dropout marks once, and again when it was let go") {
  struct Counting : SetupStep {
    Counting() : SetupStep(Calibration()) {}
    void mark(double) override { ++marks; }
    void undo() override {}
    SetupView view() const override { return {}; }
    void store(Calibration&, std::int64_t) const override {}
    void take(const SensorSample&) override {}
    int marks = 0;
  } step;
  const auto feed = [&](PoseStatus status, std::uint32_t buttons) { step.feed({0, status, {}, buttons}); };
  feed(PoseStatus::ok, 2);
  feed(PoseStatus::missing, 0);
  feed(PoseStatus::ok, 2);
  feed(PoseStatus::invalid, 2);
  CHECK(step.marks == 1);
  // A sample without a pose has its buttons all the same.
  feed(PoseStatus::invalid, 0);
  feed(PoseStatus::ok, 2);
  CHECK(step.marks == 2);
}
