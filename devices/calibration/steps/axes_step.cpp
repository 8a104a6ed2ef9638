#include <glm/geometric.hpp>

#include <utility>
#include <vector>

#include "devices/calibration/steps/finding_step.h"
#include "devices/calibration/steps/steps.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

/// Four straight moves, each between two marks.
class AxesStep : public FindingStep {
public:
  explicit AxesStep(const Calibration& base) : FindingStep(base, "Which way is which") {}
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void marked(double) override { waiting_ = true; }
  void taken_back(bool all) override;
  void take(const SensorSample& sample) override;
  void ask(SetupView& view) const override;
  std::size_t part() const override { return ends_.size(); }
  std::string result() const override;

private:
  std::vector<Pose> ends_;  ///< two per move, raw
  std::optional<Pose> newest_;
  bool waiting_ = false;  ///< for the pose of the last mark
  AxesFinding found_;
};

void AxesStep::take(const SensorSample& sample) {
  if (sample.status != PoseStatus::ok) return;
  newest_ = sample.tracker_from_sensor;
  if (!std::exchange(waiting_, false)) return;
  ends_.push_back(*newest_);
  const std::size_t count = ends_.size();
  if (count % 2 == 0 && glm::distance(ends_[count - 2].translation, ends_[count - 1].translation) < kMinMove_mm) {
    refuse("That was too short; begin this move again and move by 100 mm or more.");
    ends_.resize(count - 2);
  }
  if (count < 8) return;
  const auto move = [&](std::size_t i) { return StraightMove{ends_[2 * i], ends_[2 * i + 1]}; };
  if (!settle(check_axes({move(0), move(1), move(2), move(3)}), found_)) ends_.clear();
}

void AxesStep::taken_back(bool all) {
  waiting_ = false;
  if (all)
    ends_.clear();
  else if (!ends_.empty())
    ends_.pop_back();
}

void AxesStep::ask(SetupView& view) const {
  static constexpr const char* kBegin[] = {
      "Hold the probe upright on the mannequin's belly, its marker to the patient's right. Mark.",
      "Hold it upright as before, marker to the right. Mark.",
      "Turn the probe, still upright, until its marker points to the head. Mark.",
      "Lay the probe over so that its marker points up, away from the table. Mark."};
  static constexpr const char* kEnd[] = {
      "Move it straight to the patient's right, a hand's length (10 cm or more), without turning. Mark.",
      "Move it straight up, a hand's length (10 cm or more), without turning. Mark.",
      "Move it straight to the head, a hand's length (10 cm or more), without turning. Mark.",
      "Move it straight up, a hand's length (10 cm or more), without turning. Mark."};
  view.share = double(ends_.size()) / 8;
  const std::size_t move = ends_.size() / 2;
  view.reading = ends_.size() % 2 == 1;
  view.task = formatted("Move %zu of 4, %s: ", move + 1, view.reading ? "end" : "begin") +
              (view.reading ? kEnd[move] : kBegin[move]);
  if (view.reading && newest_)
    view.feedback =
        formatted("%.0f mm from the beginning", glm::distance(ends_.back().translation, newest_->translation));
}

std::string AxesStep::result() const {
  return found_.signs.words() + formatted("; the moves agree to %.0f degrees", found_.misfit_deg) +
         (found_.signs.none() ? "" : "; what is mirrored is put right from here on");
}

void AxesStep::store(Calibration& calibration, std::int64_t now_s) const {
  const bool other = !calibration.axes || calibration.axes->value.signs.position != found_.signs.position ||
                     calibration.axes->value.signs.quaternion != found_.signs.quaternion;
  const bool had_signs = calibration.axes || !found_.signs.none();
  calibration.axes = Dated<AxesFinding>{found_, now_s};
  if (!other || !had_signs) return;
  // Results measured with other axes are invalid.
  calibration.tip.reset();
  calibration.face.reset();
  calibration.mannequin.reset();
}

}  // namespace

std::unique_ptr<SetupStep> axes_step(const Calibration& base) {
  return std::make_unique<AxesStep>(base);
}

}  // namespace insonate
