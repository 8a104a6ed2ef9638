#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "devices/calibrated_tracker.h"
#include "devices/calibration/steps/setup_step.h"
#include "devices/registry.h"
#include "devices/rehearsal/rehearsal_tracker.h"

using namespace insonate;
using Catch::Contains;

namespace {

/// A person who rehearses: polls the hand 60 times a second, and marks.
class Person {
public:
  Person() : sensor_(open_tracker(sensor_uri("rehearsal:", false))) {}

  /// Makes a step: marks where the hand holds still, and at uneven times where it is to strike.
  void make(std::string_view name, SetupStep& step) {
    double last_mark_s = now_s_;
    std::size_t marks = 0;
    for (int i = 0; i < 60 * 60 && !step.view().done; ++i) {
      poll(name, step);
      const SetupView view = step.view();
      if (!hand().is_there() || (view.reading && name != "axes")) continue;
      const double pause_s = 0.7 + 0.1 * double(marks * marks % 7);
      if (name == "lag" && (marks == 10 || now_s_ - last_mark_s < pause_s)) continue;
      step.mark(sensor_.tracker().clock_s(now_s_));
      last_mark_s = now_s_;
      ++marks;
    }
    CAPTURE(step.view().task, step.view().feedback, step.view().refusal);
    REQUIRE(step.view().done);
  }

  void poll(std::string_view name, SetupStep& step) {
    now_s_ += 1 / RehearsalTracker::kRate_hz;
    samples_.clear();
    sensor_.poll(now_s_, samples_);
    for (const SensorSample& sample : samples_) step.feed(sample);
    hand().follow(name, step.view());
  }
  double clock_s() const { return sensor_.tracker().clock_s(now_s_); }
  RehearsalTracker& hand() { return *sensor_.tracker().rehearsed(); }

private:
  SensorTracker sensor_;
  std::vector<SensorSample> samples_;
  double now_s_ = 100;
};

SetupInput given() {
  return {.landmarks = read_landmark_list(std::string(INSONATE_ASSETS_FOLDER) + "/calibration/abdomen.toml")};
}

/// Returns how far a calibration puts the probe from where the made-up hand holds it, at worst: at its face and 100 mm
/// into the body, over half a minute of scanning.
double worst_error_mm(const Calibration& calibration) {
  const auto tracker = open_tracker(sensor_uri("rehearsal:", true));
  std::vector<ProbeSample> samples;
  tracker->poll(0, samples);
  tracker->poll(30, samples);
  double worst = 0;
  for (const ProbeSample& sample : samples) {
    if (sample.status != PoseStatus::ok) continue;
    const Pose raw = sample.patient_from_probe, found = calibration.patient_from_probe(raw);
    const Pose held = RehearsalTracker::patient_from_probe(raw);
    for (const glm::dvec3& point : {glm::dvec3(0), glm::dvec3(0, 100, 0)})
      worst = std::max(worst, glm::distance(found.point(point), held.point(point)));
  }
  return worst;
}

}  // namespace

TEST_CASE("a rehearsed set-up finds the made-up lab, and the same landmarks again after a move") {
  Person person;
  Calibration calibration;
  calibration.tracker = tracker_identity("rehearsal:");
  SetupInput input = given();
  for (const std::string_view name : kSetupSteps) {
    CAPTURE(name);
    REQUIRE(why_not_yet(name, calibration, input).empty());
    const auto step = begin_setup_step(name, calibration, input);
    person.make(name, *step);
    step->store(calibration, 1000);
  }
  CHECK(calibration.axes->value.signs.none());
  // Touches are off by 1.5 mm RMS, evenly within 1.5 mm along each axis: less than the 2 mm for which the test of
  // landmarks touched by a real hand has these bounds (steps_test.cpp).
  CHECK(calibration.mannequin->value.accuracy_mm < 5);
  CHECK(worst_error_mm(calibration) < 5);
  // The probe begins to fall two samples after the mark, and takes 80 ms. The samples are 17 ms apart.
  CHECK(calibration.lag->value.lag_s == Approx(RehearsalTracker::kFall_s + 2 / 60.0).margin(0.017));

  input.moved = true;
  const auto again = begin_setup_step("landmarks", calibration, input);
  person.make("landmarks", *again);
  again->store(calibration, 1000);
  CHECK(worst_error_mm(calibration) < 5);
}

TEST_CASE("a mark that comes before the made-up hand is there is refused") {
  Person person;
  const auto step = begin_setup_step("axes", {}, given());
  for (int i = 0; i < 30; ++i) person.poll("axes", *step);
  CHECK_FALSE(person.hand().is_there());
  CHECK_THAT(person.hand().doing(), Contains("on its way"));
  while (!person.hand().is_there()) person.poll("axes", *step);
  CHECK_THAT(person.hand().doing(), Contains("is there"));
  step->mark(person.clock_s());
  for (int i = 0; i < 10; ++i) person.poll("axes", *step);
  step->mark(person.clock_s());
  person.poll("axes", *step);
  CHECK_THAT(step->view().refusal, Contains("too short"));
}

TEST_CASE("a rehearsal without a calibration begins at the start pose") {
  TrackerContext context;
  context.start = {glm::dmat3(1.0), {10, -100, 20}};
  const auto tracker = open_tracker("rehearsal:", context);
  std::vector<ProbeSample> samples;
  tracker->poll(0, samples);
  REQUIRE(samples.size() == 1);
  CHECK(glm::distance(samples[0].patient_from_probe.translation, context.start.translation) < 1e-9);
  CHECK(tracker->live());
}
