#include "devices/calibration/setup_step.h"

#include <stdexcept>

#include "devices/calibration/steps.h"

namespace insonate {

void SetupStep::feed(const PoseSample& sample) {
  const bool pressed = (sample.buttons & ~buttons_) != 0;
  buttons_ = sample.buttons;
  if (pressed) mark(sample.time_s);
  take(sample);
}

std::string why_not_yet(std::string_view step, const Calibration& base, const SetupGiven& given) {
  const bool touches = step == "landmarks" || (step == "face" && !given.drawing);
  if (touches && !base.tip) return "The probe's tip is not known yet; make the step 'pivot' first.";
  if (step == "landmarks" && given.moved && !base.mannequin)
    return "There are no landmarks yet to find again; touch the patient's first.";
  if (step == "landmarks" && !given.moved && !given.landmarks) return "The patient's landmarks are not given.";
  return "";
}

std::unique_ptr<SetupStep> begin_setup_step(std::string_view step, const Calibration& base, const SetupGiven& given) {
  if (step == "axes") return std::make_unique<AxesStep>(base);
  if (step == "pivot") return std::make_unique<PivotStep>(base);
  if (step == "face" && given.drawing) return std::make_unique<DrawnFaceStep>(base, *given.drawing);
  if (step == "face") return std::make_unique<FaceStep>(base);
  if (step == "landmarks" && given.moved) return std::make_unique<LandmarkStep>(base);
  if (step == "landmarks") return std::make_unique<LandmarkStep>(base, *given.landmarks);
  if (step == "lag") return std::make_unique<LagStep>(base);
  throw std::invalid_argument("there is no such step of the set-up");
}

}  // namespace insonate
