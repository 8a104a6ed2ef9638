#include <algorithm>
#include <vector>

#include "devices/calibration/steps.h"

namespace insonate {
namespace {

constexpr double kLongestPivotS = 60;
constexpr double kPivotS = 10;
/// So many poses are fitted again and again while they come: some milliseconds each time.
constexpr std::size_t kFittedOnTheWay = 150;

/// That many of the poses, or all, evenly spread.
std::vector<Pose> some_of(const std::vector<Pose>& poses, std::size_t count) {
  if (poses.size() <= count) return poses;
  std::vector<Pose> picked;
  for (std::size_t i = 0; i < count; ++i) picked.push_back(poses[i * poses.size() / count]);
  return picked;
}

/// Pivoting between two marks.
class PivotStep : public SetupStep {
public:
  explicit PivotStep(const Calibration& base) : SetupStep(base) {}
  void mark(double time_s) override;
  void undo() override;
  SetupView view() const override;
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void take(const PoseSample& sample) override;

private:
  std::vector<Pose> poses_;
  double spread_deg_ = 0, began_s_ = 0, lasted_s_ = 0, told_s_ = 0;
  std::optional<double> residual_mm_;  ///< of a fit to what came so far, once there is one
  bool reading_ = false;
  std::optional<TipFit> found_;
  std::string refusal_;
};

void PivotStep::mark(double time_s) {
  if (found_) return;
  refusal_.clear();
  if (!reading_) {
    reading_ = true;
    poses_.clear();
    spread_deg_ = lasted_s_ = 0;
    residual_mm_.reset();
    began_s_ = told_s_ = time_s;
    return;
  }
  reading_ = false;
  if (const auto fit = fit_tip(poses_))
    found_ = *fit;
  else
    refusal_ = fit.refusal();
}

void PivotStep::take(const PoseSample& sample) {
  if (!reading_) return;
  lasted_s_ = std::max(0.0, sample.time_s - began_s_);
  if (sample.status == PoseStatus::ok) poses_.push_back(base_.tracker_from_sensor(sample.patient_from_probe));
  if (sample.time_s - told_s_ > 0.25) {
    told_s_ = sample.time_s;
    spread_deg_ = pivot_spread_deg(poses_);
    const auto fit = fit_tip(some_of(poses_, kFittedOnTheWay));
    residual_mm_ = fit ? std::optional(fit->residual_mm) : std::nullopt;
  }
  const bool enough = lasted_s_ > kPivotS && spread_deg_ > 1.3 * kLeastPivotSpreadDeg;
  if (enough || poses_.size() >= kMostStepPoses || lasted_s_ > kLongestPivotS) mark(sample.time_s);
}

void PivotStep::undo() {
  reading_ = false;
  found_.reset();
  refusal_.clear();
}

SetupView PivotStep::view() const {
  SetupView view;
  view.title = "Probe tip";
  view.refusal = refusal_;
  view.reading = reading_;
  view.done = found_.has_value();
  if (found_) {
    view.share = 1;
    view.result = worded("residual %.2f mm over %zu poses (%zu rejected); the tip is known to %.2f mm",
                         found_->residual_mm, found_->used, found_->rejected, found_->tip_sd_mm);
    return view;
  }
  view.task = reading_
                  ? "Keep the tip in the dimple. Tilt the probe by 30 degrees to all sides, and turn it about its "
                    "length."
                  : "Put the probe's pointed tip into a dimple that stands fast, away from metal. Mark, then pivot "
                    "for ten seconds.";
  if (!reading_) return view;
  view.share = std::min({1.0, lasted_s_ / kPivotS, spread_deg_ / (1.3 * kLeastPivotSpreadDeg)});
  view.feedback = worded("%.0f s, %zu poses, turned by %.0f of %.0f degrees", lasted_s_, poses_.size(), spread_deg_,
                         1.3 * kLeastPivotSpreadDeg);
  if (residual_mm_) view.feedback += worded(", residual %.2f mm", *residual_mm_);
  return view;
}

void PivotStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.tip = Dated<TipFit>{*found_, now_s};
}

}  // namespace

std::unique_ptr<SetupStep> pivot_step(const Calibration& base) {
  return std::make_unique<PivotStep>(base);
}

}  // namespace insonate
