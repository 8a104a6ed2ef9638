#include <algorithm>
#include <vector>

#include "devices/calibration/steps/finding_step.h"
#include "devices/calibration/steps/steps.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

constexpr double kLongestPivot_s = 60;
constexpr double kPivot_s = 10;
/// Number of poses for the repeated fits while poses arrive; each takes some milliseconds.
constexpr std::size_t kFittedOnTheWay = 150;

/// Returns `count` of the poses, evenly spread, or all if there are fewer.
std::vector<Pose> some_of(const std::vector<Pose>& poses, std::size_t count) {
  if (poses.size() <= count) return poses;
  std::vector<Pose> picked;
  for (std::size_t i = 0; i < count; ++i) picked.push_back(poses[i * poses.size() / count]);
  return picked;
}

/// Pivoting between two marks.
class PivotStep : public FindingStep {
public:
  explicit PivotStep(const Calibration& base) : FindingStep(base, "Probe tip") {}
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void marked(double time_s) override;
  void taken_back(bool) override { reading_ = false; }
  void take(const SensorSample& sample) override;
  void ask(SetupView& view) const override;
  std::string result() const override;

private:
  std::vector<Pose> poses_;
  double spread_deg_ = 0, began_s_ = 0, lasted_s_ = 0, evaluated_s_ = 0;
  std::optional<double> residual_mm_;  ///< residual of a fit to the poses so far, if there is one
  bool reading_ = false;
  TipFit found_;
};

void PivotStep::marked(double time_s) {
  if (!reading_) {
    reading_ = true;
    poses_.clear();
    spread_deg_ = lasted_s_ = 0;
    residual_mm_.reset();
    began_s_ = evaluated_s_ = time_s;
    return;
  }
  reading_ = false;
  settle(fit_tip(poses_), found_);
}

void PivotStep::take(const SensorSample& sample) {
  if (!reading_) return;
  lasted_s_ = std::max(0.0, sample.time_s - began_s_);
  if (sample.status == PoseStatus::ok) poses_.push_back(base_.tracker_from_sensor(sample.tracker_from_sensor));
  if (sample.time_s - evaluated_s_ > 0.25) {
    evaluated_s_ = sample.time_s;
    spread_deg_ = pivot_spread_deg(poses_);
    const auto fit = fit_tip(some_of(poses_, kFittedOnTheWay));
    residual_mm_ = fit ? std::optional(fit->residual_mm) : std::nullopt;
  }
  const bool enough = lasted_s_ > kPivot_s && spread_deg_ > 1.3 * kMinPivotSpread_deg;
  if (enough || poses_.size() >= kMaxStepPoses || lasted_s_ > kLongestPivot_s) mark(sample.time_s);
}

void PivotStep::ask(SetupView& view) const {
  view.reading = reading_;
  view.task = reading_
                  ? formatted(
                        "Keep the tip in the dimple. Tilt the probe by %d degrees to all sides, and turn it about "
                        "its length.",
                        kPivotTilt_deg)
                  : "Put the probe's pointed tip into a dimple that stands fast, away from metal. Mark, then pivot "
                    "for ten seconds.";
  if (!reading_) return;
  view.share = std::min({1.0, lasted_s_ / kPivot_s, spread_deg_ / (1.3 * kMinPivotSpread_deg)});
  view.feedback = formatted("%.0f s, %zu poses, turned by %.0f %% of what is needed", lasted_s_, poses_.size(),
                            std::min(100.0, std::floor(100 * spread_deg_ / (1.3 * kMinPivotSpread_deg))));
  if (residual_mm_) view.feedback += formatted(", residual %.2f mm", *residual_mm_);
}

std::string PivotStep::result() const {
  return formatted(
      "residual %.2f mm over %zu poses (%zu rejected), where below 1 mm is good; the tip's place is uncertain by %.2f "
      "mm",
      found_.residual_mm, found_.used, found_.rejected, found_.tip_sd_mm);
}

void PivotStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.tip = Dated<TipFit>{found_, now_s};
}

}  // namespace

std::unique_ptr<SetupStep> pivot_step(const Calibration& base) {
  return std::make_unique<PivotStep>(base);
}

}  // namespace insonate
