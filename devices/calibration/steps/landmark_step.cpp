#include <vector>

#include "devices/calibration/steps/steps.h"
#include "devices/calibration/steps/touching_step.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

/// The mannequin's landmarks, touched with the tip.
class LandmarkStep : public TouchingStep {
public:
  LandmarkStep(const Calibration& base, const LandmarkList& list)
      : TouchingStep(base, "Landmarks", list.landmarks.size()), patient_(list.patient), pairs_(list.landmarks) {
    for (const LandmarkPair& pair : pairs_) places_mm_.push_back(pair.ct_mm);
  }
  /// The landmarks of the last set-up again, after the base or the mannequin was moved.
  explicit LandmarkStep(const Calibration& base)
      : TouchingStep(base, "Landmarks, moved", base.mannequin->value.landmarks.size()),
        patient_(base.mannequin->value.patient),
        pairs_(base.mannequin->value.landmarks),
        moved_(true) {
    for (LandmarkPair& pair : pairs_) {
      places_mm_.push_back(pair.ct_mm);
      pair.ct_mm = pair.touched_mm;
    }
  }
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  std::string task(std::size_t touch) const override;
  glm::dvec3 point(std::size_t touch, const Pose& tracker_from_sensor) const override;
  void finish() override;
  void ask(SetupView& view) const override;
  std::string result() const override;

private:
  std::string patient_;
  std::vector<LandmarkPair> pairs_;    ///< ct_mm: target of the fit; if moved, places in the mannequin's frame
  std::vector<glm::dvec3> places_mm_;  ///< of the landmarks in the patient
  bool moved_ = false;
  Registration found_;
};

std::string LandmarkStep::task(std::size_t touch) const {
  return "Touch " + pairs_[touch].name + " with the tip. Mark, and hold still.";
}

void LandmarkStep::ask(SetupView& view) const {
  TouchingStep::ask(view);
  view.landmark_mm = places_mm_[points_.size()];
}

glm::dvec3 LandmarkStep::point(std::size_t, const Pose& tracker_from_sensor) const {
  return tracker_from_sensor.point(base_.tip->value.tip_mm);
}

void LandmarkStep::finish() {
  for (std::size_t i = 0; i < pairs_.size(); ++i) pairs_[i].touched_mm = points_[i];
  settle(register_landmarks(pairs_), found_);
}

std::string LandmarkStep::result() const {
  std::string checked;
  for (const LandmarkPair& pair : pairs_)
    if (pair.held_out) checked += (checked.empty() ? "" : ", ") + pair.name;
  return formatted(
      "accuracy %.1f mm (below 3 mm is good), measured at what was left out of the fit: %s. The fitted places "
      "are %.1f mm off (RMS); %s is off most, by %.1f mm",
      found_.accuracy_mm, checked.c_str(), found_.residual_mm, found_.worst.c_str(), found_.worst_mm);
}

void LandmarkStep::store(Calibration& calibration, std::int64_t now_s) const {
  MannequinSetup setup;
  if (moved_) {
    setup = base_.mannequin->value;
    setup.mannequin_from_tracker = found_.ct_from_touched;
  } else {
    setup.patient = patient_;
    setup.ct_from_mannequin = found_.ct_from_touched;
    setup.landmarks = pairs_;
  }
  setup.accuracy_mm = found_.accuracy_mm;
  setup.residual_mm = found_.residual_mm;
  setup.worst = found_.worst.empty() ? pairs_.front().name : found_.worst;
  setup.worst_mm = found_.worst_mm;
  calibration.mannequin = Dated<MannequinSetup>{setup, now_s};
}

}  // namespace

std::unique_ptr<SetupStep> landmark_step(const Calibration& base, const LandmarkList& list) {
  return std::make_unique<LandmarkStep>(base, list);
}

std::unique_ptr<SetupStep> moved_landmark_step(const Calibration& base) {
  return std::make_unique<LandmarkStep>(base);
}

}  // namespace insonate
