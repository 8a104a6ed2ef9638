#include <algorithm>
#include <vector>

#include "devices/calibration/steps.h"

namespace insonate {
namespace {

/// Blows on a key.
class LagStep : public SetupStep {
public:
  static constexpr std::size_t kBlows = 10;

  explicit LagStep(const Calibration& base) : SetupStep(base) {}
  void mark(double time_s) override;
  void undo() override;
  SetupView view() const override;
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void take(const PoseSample& sample) override;

private:
  std::vector<PoseSample> samples_;
  std::vector<double> blows_s_;
  std::optional<KnockLag> found_;
  std::string refusal_;
};

void LagStep::mark(double time_s) {
  if (found_) return;
  refusal_.clear();
  blows_s_.push_back(time_s);
}

void LagStep::take(const PoseSample& sample) {
  if (found_) return;
  samples_.push_back(sample);
  const bool over = blows_s_.size() >= kBlows && sample.time_s > blows_s_.back() + kMostLagS + 0.5;
  if (!over && samples_.size() < kMostStepPoses) return;
  const auto found = knock_lag(samples_, blows_s_);
  if (found)
    found_ = *found;
  else
    refusal_ = found.refusal();
  samples_.clear();
  blows_s_.clear();
}

void LagStep::undo() {
  found_.reset();
  refusal_.clear();
  samples_.clear();
  blows_s_.clear();
}

SetupView LagStep::view() const {
  SetupView view;
  view.title = "Lag";
  view.refusal = refusal_;
  view.done = found_.has_value();
  view.share = found_ ? 1 : std::min(1.0, double(blows_s_.size()) / double(kBlows));
  view.part = blows_s_.size();
  if (found_) {
    view.result = worded("the tracker lags by %.0f ms, single blows within %.0f ms of it", found_->lag_s * 1e3,
                         found_->spread_s * 1e3);
    return view;
  }
  view.task = worded(
      "Strike the key that marks with the probe itself, %zu times, with uneven pauses of a second or so.", kBlows);
  view.feedback = worded("%zu of %zu", blows_s_.size(), kBlows);
  return view;
}

void LagStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.lag = Dated<KnockLag>{*found_, now_s};
}

}  // namespace

std::unique_ptr<SetupStep> lag_step(const Calibration& base) {
  return std::make_unique<LagStep>(base);
}

}  // namespace insonate
