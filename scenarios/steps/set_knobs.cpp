#include "scenarios/steps/set_knobs.h"

#include <algorithm>

#include "scenarios/metrics/motion_meter.h"
#include "scenarios/words.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/probe/probe.h"

namespace insonate {
namespace {

class SetKnobsRun : public StepRun {
public:
  SetKnobsRun(const SetKnobs& asked, double now_s) : asked_(asked), wrong_until_s_(now_s) {}

  void see(const Moment& moment) override {
    right_percent_ = right_percent(moment.machine);
    if (right_percent_ < 100) wrong_until_s_ = moment.now_s;
    held_s_ = moment.now_s - wrong_until_s_;
  }
  bool done() const override { return right_percent_ >= 100 && held_s_ >= asked_.hold_s - kTimeRounding_s; }
  bool on_target() const override { return right_percent_ >= 100; }
  double share_done() const override { return std::min(1.0, held_s_ / asked_.hold_s); }

  void finish(StepOutcome, double, StepResult& result) const override {
    result.values.emplace_back(Metric::knobs_right_percent, right_percent_);
  }

private:
  double right_percent(const Machine& machine) const {
    int wanted = 0, right = 0;
    const auto see = [&](const std::optional<NumberRange>& range, double value) {
      if (!range) return;
      ++wanted;
      right += value >= range->least && value <= range->most;
    };
    see(asked_.depth_mm, machine.depth_mm);
    see(asked_.gain_db, machine.gain_db);
    see(asked_.frequency_mhz, machine.frequency_mhz);
    if (!asked_.probe.empty()) {
      ++wanted;
      right += machine.probe == asked_.probe;
    }
    return 100.0 * right / wanted;
  }

  const SetKnobs& asked_;
  double right_percent_ = 0;
  double wrong_until_s_;
  double held_s_ = 0;
};

}  // namespace

std::shared_ptr<const StepTask> SetKnobs::read(const TomlTable& table, const Step&) {
  auto task = std::make_shared<SetKnobs>();
  task->depth_mm = table.interval("depth_mm", {1, 1000});
  task->gain_db = table.interval("gain_db", {-100, 100});
  task->frequency_mhz = table.interval("frequency_mhz", {0.1, 100});
  task->probe = table.text("probe", "");
  task->hold_s = table.number("hold_s", {0.1, 60}, 1);
  if (table.has("probe") && !find_probe(task->probe))
    table.report("probe", "there is no probe " + in_quotes(task->probe), suggest(task->probe, probe_names()));
  if (!table.has("depth_mm") && !table.has("gain_db") && !table.has("frequency_mhz") && !table.has("probe"))
    table.report("", "no setting is asked for", "add depth_mm, gain_db, frequency_mhz or probe");
  return task;
}

std::vector<ActionKind> SetKnobs::settings() const {
  std::vector<ActionKind> asked;
  if (!probe.empty()) asked.push_back(ActionKind::probe);
  if (depth_mm) asked.push_back(ActionKind::depth);
  if (frequency_mhz) asked.push_back(ActionKind::frequency);
  if (gain_db) asked.push_back(ActionKind::gain);
  return asked;
}

StepInput SetKnobs::input() const {
  return SettingsInput{[this](const Machine& machine) {
    std::vector<SettingsInput::Setting> settings;
    const auto add = [&](const char* name, const std::optional<NumberRange>& wanted, double now, double per_unit,
                         const char* unit) {
      if (!wanted) return;
      const auto number = [&](double value) { return short_number(value / per_unit); };
      settings.push_back({name, number(wanted->least) + " to " + number(wanted->most) + " " + unit,
                          number(now) + " " + unit, now >= wanted->least && now <= wanted->most});
    };
    if (const Probe* wanted = find_probe(probe))
      settings.push_back({"Probe", wanted->title, machine.transducer().title, machine.probe == wanted->name});
    add("Depth", depth_mm, machine.depth_mm, 10, "cm");
    add("Gain", gain_db, machine.gain_db, 1, "dB");
    add("Frequency", frequency_mhz, machine.frequency_mhz, 1, "MHz");
    return settings;
  }};
}

StepBegin SetKnobs::prepare(const StepWorld&) const {
  return [this](double now_s) { return std::make_unique<SetKnobsRun>(*this, now_s); };
}

}  // namespace insonate
