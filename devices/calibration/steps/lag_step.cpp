#include <algorithm>
#include <vector>

#include "devices/calibration/steps/finding_step.h"
#include "devices/calibration/steps/steps.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

/// Knocks on a key.
class LagStep : public FindingStep {
public:
  static constexpr std::size_t kBlows = 10;

  explicit LagStep(const Calibration& base) : FindingStep(base, "Delay of the tracker") {}
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void marked(double time_s) override { blows_s_.push_back(time_s); }
  void taken_back(bool) override { begin_again(); }
  void take(const SensorSample& sample) override;
  void ask(SetupView& view) const override;
  std::size_t part() const override { return done() ? kBlows : blows_s_.size(); }
  std::string result() const override;

private:
  void begin_again() {
    samples_.clear();
    blows_s_.clear();
  }
  std::vector<SensorSample> samples_;
  std::vector<double> blows_s_;
  KnockLag found_;
};

void LagStep::take(const SensorSample& sample) {
  if (done()) return;
  samples_.push_back(sample);
  const bool over = blows_s_.size() >= kBlows && sample.time_s > blows_s_.back() + kMaxLag_s + 0.5;
  if (!over && samples_.size() < kMaxStepPoses) return;
  settle(knock_lag(samples_, blows_s_), found_);
  begin_again();
}

void LagStep::ask(SetupView& view) const {
  view.share = std::min(1.0, double(blows_s_.size()) / double(kBlows));
  view.task = formatted(
      "Strike the key that marks with the probe itself, %zu times, with uneven pauses of a second or so.", kBlows);
  view.feedback = formatted("%zu of %zu", blows_s_.size(), kBlows);
}

std::string LagStep::result() const {
  return formatted(
      "the tracker's poses come %.0f ms %s (below 100 ms is good; scans do not correct it); single "
      "blows differ by %.0f ms (RMS)",
      std::abs(found_.lag_s) * 1e3, found_.lag_s < 0 ? "early" : "late", found_.spread_s * 1e3);
}

void LagStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.lag = Dated<KnockLag>{found_, now_s};
}

}  // namespace

std::unique_ptr<SetupStep> lag_step(const Calibration& base) {
  return std::make_unique<LagStep>(base);
}

}  // namespace insonate
