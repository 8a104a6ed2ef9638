#include "devices/calibration/steps/setup_step.h"

#include <stdexcept>

#include "devices/calibration/steps/steps.h"
#include "sim/core/text.h"

namespace insonate {

void SetupStep::feed(const SensorSample& sample) {
  if (presses_.see(sample) != 0) mark(sample.time_s);
  take(sample);
}

std::string why_not_yet(std::string_view step, const Calibration& base, const SetupInput& given) {
  const bool touches = step == "landmarks" || (step == "face" && !given.drawing);
  if (touches && !base.tip) return "The probe's tip is not known yet; make the step Probe tip ('pivot') first.";
  if (step == "landmarks" && given.moved && !base.mannequin)
    return "There are no landmarks yet to find again; touch the patient's first.";
  if (step == "landmarks" && !given.moved && !given.landmarks) return "The patient's landmarks are not given.";
  return "";
}

std::unique_ptr<SetupStep> begin_setup_step(std::string_view step, const Calibration& base, const SetupInput& given) {
  if (step == "axes") return axes_step(base);
  if (step == "pivot") return pivot_step(base);
  if (step == "face" && given.drawing) return drawn_face_step(base, *given.drawing);
  if (step == "face") return face_step(base);
  if (step == "landmarks" && given.moved) return moved_landmark_step(base);
  if (step == "landmarks") return landmark_step(base, *given.landmarks);
  if (step == "lag") return lag_step(base);
  throw std::invalid_argument("there is no such step of the set-up");
}

}  // namespace insonate
