#include "scenarios/steps/find_view.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <deque>
#include <string_view>

#include "scenarios/metrics/motion_meter.h"
#include "scenarios/metrics/view_meter.h"
#include "scenarios/steps/structures.h"
#include "scenarios/words.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

constexpr double kLargestLimit = 1000;

std::vector<Tolerance> read_tolerance(const TomlTable& table) {
  std::vector<std::string> usable;
  for (const MetricInfo& m : metrics())
    if (m.scope == MetricScope::picture) usable.emplace_back(m.name);

  const std::vector<std::string> names = table.keys();
  std::vector<Tolerance> tolerance;
  for (const std::string& name : names) {
    const auto metric = find_metric(name);
    if (!metric || info(*metric).scope != MetricScope::picture)
      table.report_at(table.key_place(name), in_quotes(name) + " is not a metric of a picture", suggest(name, usable));
    else
      tolerance.push_back({*metric, table.number(name, {0, kLargestLimit}), table.key_place(name)});
  }
  if (names.empty()) table.report("", "it is empty", "add a limit, for example plane_distance_mm = 5");
  return tolerance;
}

ViewValues all_zero() {
  ViewValues values;
  values.off_centre_percent = 0;
  return values;
}

/// Adds the absolute values of a picture, multiplied by a weight.
void add(ViewValues& sum, const ViewValues& view, double weight) {
  for (const auto& [metric, value] : ViewValues::fields()) sum.*value += weight * std::abs(view.*value);
}

bool meets(const Tolerance& tolerance, const ViewValues& view) {
  const double value = view.of(tolerance.metric);
  return info(tolerance.metric).less_is_better ? value <= tolerance.limit : value >= tolerance.limit;
}

/// Returns a limit that a picture does not meet, and its value, as the end of a sentence.
std::string lack(const Tolerance& limit, const ViewValues& view) {
  return std::string(info(limit.metric).words) + ": " + in_words(limit.metric, view.of(limit.metric)) +
         ", asked for: " + in_words(limit.metric, limit.limit) +
         (info(limit.metric).less_is_better ? " or less" : " or more");
}

/// Returns a limit in short: "8 mm", "20\u00b0".
std::string limit_text(const Tolerance& limit) {
  const std::string unit(info(limit.metric).unit);
  return short_number(limit.limit) + (unit == "\u00b0" || unit.empty() ? "" : " ") + unit;
}

std::string lower_case(std::string_view words) {
  std::string text(words);
  text.front() = char(std::tolower(static_cast<unsigned char>(text.front())));
  return text;
}

class FindViewRun : public StepRun {
public:
  explicit FindViewRun(const FindView& asked) : asked_(asked) {}

  void see(const Moment& moment) override {
    const double now = moment.now_s;
    if (moment.valid) {
      if (!bridged(now)) holding_from_.reset();
      within_tolerance_ = within_tolerance(*moment.view);
      recent_.push_back({now, *moment.view});
      while (recent_.front().time_s < now - asked_.hold_s - MotionMeter::kBridged_s) recent_.pop_front();
    } else {
      within_tolerance_ = false;
    }
    if (!bridged(now) || (moment.valid && !within_tolerance_))
      holding_from_.reset();
    else if (moment.valid && !holding_from_)
      holding_from_ = now;

    const double holding_s = holding_from_ ? now - *holding_from_ : 0;
    held_ = moment.valid && holding_s >= asked_.hold_s - kTimeRounding_s;
    if (moment.valid) longest_hold_s_ = std::max(longest_hold_s_, held_ ? asked_.hold_s : holding_s);
    share_ = std::min(1.0, holding_s / asked_.hold_s);
  }

  bool done() const override { return held_; }
  double share_done() const override { return share_; }
  bool on_target() const override { return within_tolerance_; }

  std::string lacks() const override {
    if (within_tolerance_ || recent_.empty()) return "";
    const ViewValues& view = recent_.back().view;
    for (const Tolerance& t : asked_.tolerance)
      if (!meets(t, view)) return lack(t, view) + ".";
    return "";
  }

  void finish(StepOutcome outcome, double, StepResult& result) const override {
    result.longest_hold_s = longest_hold_s_;
    result.values.emplace_back(Metric::longest_hold_s, longest_hold_s_);
    if (recent_.empty()) return;
    const double to = recent_.back().time_s;
    const double from = outcome == StepOutcome::held ? *holding_from_ : to - asked_.hold_s;
    ViewValues integral = all_zero(), mean = all_zero();
    double weight = 0;
    const Seen* before = nullptr;
    for (const Seen& seen : recent_) {
      if (seen.time_s < from - kTimeRounding_s) continue;
      if (!result.judged_from_s) result.judged_from_s = seen.time_s;
      if (before && MotionMeter::bridges(seen.time_s - before->time_s)) {
        const double dt = seen.time_s - before->time_s;
        add(integral, before->view, dt / 2);
        add(integral, seen.view, dt / 2);
        weight += dt;
      }
      before = &seen;
    }
    result.judged_to_s = to;
    if (weight > 0)
      add(mean, integral, 1 / weight);
    else
      add(mean, recent_.back().view, 1);
    result.judged = mean;
    if (outcome == StepOutcome::held) return;
    std::string missed;
    for (const Tolerance& t : asked_.tolerance)
      if (!meets(t, mean)) missed += (missed.empty() ? "" : "; ") + lack(t, mean);
    if (!missed.empty()) result.facts.emplace_back(StepResult::kNotHeld, missed);
  }

private:
  struct Seen {
    double time_s;
    ViewValues view;
  };

  bool bridged(double now) const { return !recent_.empty() && MotionMeter::bridges(now - recent_.back().time_s); }

  bool within_tolerance(const ViewValues& view) const {
    return std::ranges::all_of(asked_.tolerance, [&](const Tolerance& t) { return meets(t, view); });
  }

  const FindView& asked_;
  std::deque<Seen> recent_;             ///< valid samples, as far back as judging can need
  std::optional<double> holding_from_;  ///< start of the current hold
  double longest_hold_s_ = 0;
  double share_ = 0;
  bool held_ = false;
  bool within_tolerance_ = false;
};

}  // namespace

StepWords FindView::words() const {
  std::string near, others;
  for (const Tolerance& t : tolerance) {
    const bool of_plane = t.metric == Metric::plane_distance_mm || t.metric == Metric::plane_angle_deg;
    if (of_plane)
      near += (near.empty() ? " within " : " and ") + limit_text(t);
    else
      others += ", " + lower_case(info(t.metric).words) + (info(t.metric).less_is_better ? " at most " : " at least ") +
                limit_text(t);
  }
  if (!near.empty()) near += " of the asked plane";
  const std::string after = short_number(hold_s) + " s" + near + others;
  StepWords words{{}, "Searching", "Hold still", false};
  words.prompt = "The view is taken as it is, also in motion, after " + after + ".";
  return words;
}

std::shared_ptr<const StepTask> FindView::read(const TomlTable& table, const Step& step) {
  auto task = std::make_shared<FindView>();
  task->hold_s = table.number("hold_s", {0.1, 60}, 1);
  if (table.has("hold_s") && table.has("time_limit_s") && task->hold_s >= step.time_limit_s)
    table.report("hold_s", "the view has to be held longer than the time limit allows",
                 "shorten hold_s or raise time_limit_s");
  task->tolerance = read_tolerance(table.table("tolerance"));
  return task;
}

std::vector<ActionKind> FindView::settings() const {
  const bool judges_depth = std::any_of(tolerance.begin(), tolerance.end(),
                                        [](const Tolerance& t) { return t.metric == Metric::depth_use_percent; });
  return judges_depth ? std::vector{ActionKind::depth} : std::vector<ActionKind>();
}

void FindView::check(const Step& step, const LabelIndex& labels, const std::string& where,
                     std::vector<Mistake>& problems) const {
  for (const Tolerance& limit : tolerance)
    check_metric(limit.metric, limit.place, step, labels.subject(), where, problems);
}

StepBegin FindView::prepare(const StepWorld&) const {
  return [this](double) { return std::make_unique<FindViewRun>(*this); };
}

}  // namespace insonate
