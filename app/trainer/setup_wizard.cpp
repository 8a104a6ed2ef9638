#include "app/trainer/setup_wizard.h"

#include <ctime>
#include <utility>

#include "devices/rehearsal/rehearsal_tracker.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

constexpr std::size_t kLandmarks = 3;
static_assert(kSetupSteps[kLandmarks] == "landmarks");

/// What the steps say of themselves, in the order of kSetupSteps; empty for those that were not made.
std::vector<std::string> figures(const Calibration& c) {
  std::vector<std::string> made(kSetupSteps.size());
  if (c.axes)
    made[0] = c.axes->value.signs.none() ? formatted("moves agree to %.0f\u00b0", c.axes->value.misfit_deg)
                                         : "a mirrored axis was put right";
  if (c.tip) made[1] = formatted("residual %.2f mm", c.tip->value.residual_mm);
  if (c.face) made[2] = formatted("off the right angle by %.1f\u00b0", c.face->value.fit.skew_deg);
  if (c.mannequin) made[3] = formatted("accuracy %.1f mm", c.mannequin->value.accuracy_mm);
  if (c.lag)
    made[4] = formatted("%.0f ms %s", std::abs(c.lag->value.lag_s) * 1e3, c.lag->value.lag_s < 0 ? "early" : "late");
  return made;
}

}  // namespace

SetupWizard::SetupWizard(SensorTracker sensor, Calibration base, SetupInput given, std::filesystem::path file)
    : sensor_(std::move(sensor)), calibration_(std::move(base)), given_(std::move(given)), file_(std::move(file)) {
  const std::vector<std::string> made = figures(calibration_);
  std::size_t first = 0;
  while (first + 1 < made.size() && !made[first].empty()) ++first;
  if (!made.back().empty() || !why_not(first).empty()) first = 0;
  begin(first);
}

void SetupWizard::begin(std::size_t step) {
  step_ = begin_setup_step(kSetupSteps[step], calibration_, given_);
  current_ = step;
  kept_ = false;
}

void SetupWizard::update(double now_s) {
  now_s_ = now_s;
  samples_.clear();
  sensor_.poll(now_s, samples_);
  for (const SensorSample& sample : samples_) {
    const SensorSample seen = presses_.only_pressed(sample);
    if (!step_->view().done)
      step_->feed(seen);
    else if (seen.buttons != 0)
      go_on();
    keep_if_done();
  }
  keep_if_done();  // a drawn face is done without a sample
  if (RehearsalTracker* const hand = sensor_.tracker().rehearsed()) {
    hand->follow(kSetupSteps[current_], step_->view());
    rehearsal_ = hand->doing();
  }
}

void SetupWizard::keep_if_done() {
  if (kept_ || !step_->view().done) return;
  kept_ = true;
  kept_s_ = now_s_;
  step_->store(calibration_, std::int64_t(std::time(nullptr)));
  write_calibration(file_, calibration_);
}

void SetupWizard::mark(double now_s) {
  if (step_->view().done)
    go_on();
  else if (tracker_state().condition != TrackerCondition::waiting)  // otherwise the first pose to come would be marked
    step_->mark(sensor_.tracker().clock_s(now_s));
}

bool SetupWizard::strikes_on() const {
  constexpr double kUnread_s = 3;  // longer than the pause between two blows
  return step_->view().done && kSetupSteps[current_] == "lag" && now_s_ - kept_s_ < kUnread_s;
}

void SetupWizard::go_on() {
  if (strikes_on()) {
    kept_s_ = now_s_;
    return;
  }
  if (current_ + 1 == kSetupSteps.size())
    finished_ = true;
  else
    go_to(current_ + 1);
}

void SetupWizard::undo() {
  step_->undo();
  kept_ = false;
}

std::string SetupWizard::why_not(std::size_t step) const {
  return why_not_yet(kSetupSteps[step], calibration_, given_);
}

void SetupWizard::go_to(std::size_t step) {
  given_.moved = false;
  if (why_not(step).empty()) begin(step);
}

void SetupWizard::set_moved(bool moved) {
  if (!can_be_moved()) return;
  given_.moved = moved;
  begin(kLandmarks);
}

std::vector<LandmarkPair> SetupWizard::landmarks() const {
  if (given_.moved) return calibration_.mannequin->value.landmarks;
  return given_.landmarks ? given_.landmarks->landmarks : std::vector<LandmarkPair>();
}

std::vector<SetupWizard::Row> SetupWizard::rows() const {
  static constexpr const char* kTitles[kSetupSteps.size()] = {"Which way is which", "Probe tip", "Probe face",
                                                              "Landmarks", "Delay"};
  const std::vector<std::string> made = figures(calibration_);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < kSetupSteps.size(); ++i) rows.push_back({kSetupSteps[i], kTitles[i], made[i]});
  return rows;
}

std::string SetupWizard::title_of(std::string_view name) const {
  for (const Row& row : rows())
    if (row.name == name) return row.title;
  return "";
}

}  // namespace insonate
