#include "devices/calibration/steps/steps.h"
#include "devices/calibration/steps/touching_step.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

/// A sharp fixed corner, touched with the tip and then with four places of the probe.
class FaceStep : public TouchingStep {
public:
  explicit FaceStep(const Calibration& base) : TouchingStep(base, "Probe face", 5) {}
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  std::string task(std::size_t touch) const override;
  glm::dvec3 point(std::size_t touch, const Pose& tracker_from_sensor) const override;
  void finish() override;
  std::string result() const override;

private:
  FaceFit found_;
};

/// The face from its drawing; the user has nothing to do.
class DrawnFaceStep : public SetupStep {
public:
  DrawnFaceStep(const Calibration& base, const ProbeDrawing& drawing);
  void mark(double) override {}
  void undo() override {}
  SetupView view() const override { return view_; }
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void take(const SensorSample&) override {}

private:
  FaceSetup found_;
  SetupView view_;
};

std::string FaceStep::task(std::size_t touch) const {
  static constexpr const char* kTasks[] = {
      "Touch a sharp corner that stands fast with the probe's pointed tip. Mark, and hold still.",
      "Touch the same corner with the middle of the probe's face. Mark, and hold still.",
      "Touch it with the end of the face on the marker's side. Mark, and hold still.",
      "Touch it with the other end of the face. Mark, and hold still.",
      "Touch it with the probe's tail, where the cable leaves. Mark, and hold still."};
  return kTasks[touch];
}

glm::dvec3 FaceStep::point(std::size_t touch, const Pose& tracker_from_sensor) const {
  if (touch == 0) return tracker_from_sensor.point(base_.tip->value.tip_mm);
  return tracker_from_sensor.inverse().point(points_[0]);
}

void FaceStep::finish() {
  settle(fit_face({points_[1], points_[2], points_[3], points_[4]}), found_);
}

std::string FaceStep::result() const {
  return formatted(
      "face and handle are %.1f degrees off a right angle, where below 3 is good; the touched middle lies %.1f mm from "
      "halfway between the ends",
      found_.skew_deg, found_.off_middle_mm);
}

void FaceStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.face = Dated<FaceSetup>{FaceSetup{found_, "touch", 0}, now_s};
}

DrawnFaceStep::DrawnFaceStep(const Calibration& base, const ProbeDrawing& drawing) : SetupStep(base) {
  const auto face = face_from_drawing(drawing, base.tip ? std::optional(base.tip->value) : std::nullopt);
  view_.title = "Probe face";
  view_.refusal = face.refusal();
  view_.done = bool(face);
  if (!face) return;
  found_ = *face;
  view_.share = 1;
  view_.result =
      "taken from the drawing of " + drawing.name +
      (found_.tip_off_mm > 0 ? formatted(", shifted by the %.1f mm that the tip lies elsewhere", found_.tip_off_mm)
                             : std::string());
}

void DrawnFaceStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.face = Dated<FaceSetup>{found_, now_s};
}

}  // namespace

std::unique_ptr<SetupStep> face_step(const Calibration& base) {
  return std::make_unique<FaceStep>(base);
}

std::unique_ptr<SetupStep> drawn_face_step(const Calibration& base, const ProbeDrawing& drawing) {
  return std::make_unique<DrawnFaceStep>(base, drawing);
}

}  // namespace insonate
