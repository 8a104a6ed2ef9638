#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/attempt_mode.h"
#include "scenarios/metrics/metric.h"
#include "scenarios/metrics/motion_meter.h"
#include "scenarios/metrics/view_meter.h"

namespace insonate {

/// The score of one criterion, with the reason.
struct CriterionScore {
  Metric metric{};
  double full = 0;  ///< full, zero, weight, critical: as in the scenario
  double zero = 0;
  double weight = 0;
  bool critical = false;
  std::optional<double> value;  ///< in the metric's unit; empty when it could not be measured
  double points = 0;            ///< 0 to weight
  std::string why;              ///< one sentence: "12.4 mm: between full points at 5.0 mm and none at 20.0 mm."

  bool fails_exam() const { return critical && points <= 0; }
};

/// How a step ended.
enum class StepOutcome {
  held,        ///< the view was held for the required time
  done,        ///< a step of another kind was completed
  went_on,     ///< the learner ended the step before completing it
  timed_out,   ///< the time limit of the step or of the exam ran out first
  scan_ended,  ///< the samples ended
  skipped,     ///< `[step.next]` of another step went past it
  not_reached  ///< the exam ended before it
};

/// Returns true if the step was completed.
inline bool is_done(StepOutcome outcome) {
  return outcome == StepOutcome::held || outcome == StepOutcome::done;
}

/// The result of one step.
struct StepResult {
  std::string title;
  std::string kind;
  bool holds_view = false;  ///< done by holding a view; known while the runner decides, and not stored
  bool counts = true;       ///< false for a warm-up: its scores earn no points
  std::string view;
  StepOutcome outcome = StepOutcome::not_reached;
  double start_s = 0;  ///< since the start of the exam
  double end_s = 0;
  std::optional<double> judged_from_s;  ///< the picture is judged from here to judged_to_s
  std::optional<double> judged_to_s;
  std::optional<ViewValues> judged;  ///< means of the absolute values over that time; empty without a valid sample
  double longest_hold_s = 0;
  std::vector<std::pair<Metric, double>> values;           ///< other values measured by this kind of step
  std::vector<std::pair<std::string, std::string>> facts;  ///< other information for the reader: "answer", "a stone"
  static constexpr const char* kMeasured = "measured";     ///< the fact that is the learner's own value: "188 ml"
  static constexpr const char* kLengths = "lengths";       ///< the fact of what it comes from: "34.3 mm, 33.6 mm"
  static constexpr const char* kNotHeld =
      "missed at the end";  ///< the fact that names limits which kept the view from being held
  MotionValues motion;
  std::vector<CriterionScore> criteria;
  int hints_taken = 0;
  double hint_cost = 0;  ///< subtracted from the points of the criteria; the remainder is at least 0
  int guide_times = 0;   ///< how often the guide to the step's view was shown; it costs no points
  double guide_s = 0;    ///< for how long in all

  double possible() const;       ///< points that can be earned; 0 for a warm-up
  double earned() const;         ///< points of the criteria minus the cost of the hints, at least 0
  double lost_to_hints() const;  ///< at most the points of the criteria
  /// Returns the value of a metric in `values`, if it is there.
  std::optional<double> value(Metric step_metric) const {
    for (const auto& [metric, measured] : values)
      if (metric == step_metric) return measured;
    return std::nullopt;
  }
};

/// The inputs of a score, so that it can be computed again.
struct Provenance {
  std::string program_version;
  int scoring_version = 0;          ///< ExamResult::kScoringVersion of that program
  std::optional<AttemptMode> mode;  ///< empty if the score was stored without its mode
  std::string scenario;             ///< file name
  std::string scenario_digest;
  std::string case_name;
  std::string case_digest;
  std::vector<std::pair<std::string, std::string>> phantom_options;
  std::uint32_t seed = 0;  ///< selected the variant
  std::string variant;     ///< empty when the scenario has none
  std::string log;         ///< file name; empty for a live scan that was not recorded
  std::string log_digest;
  std::string log_transform;  ///< the transform used as the probe's pose: "ProbeToPatient"
};

/// The result of an exam: its scores and the inputs that they were computed from.
struct ExamResult {
  /// Incremented whenever the same samples could get a different score.
  static constexpr int kScoringVersion = 4;

  std::string title;
  std::string briefing;  ///< what the learner read before the start; empty if the scenario has none
  Provenance provenance;
  bool complete = false;  ///< all steps, the time or the samples ended; else it is a partial result
  double points = 0;
  double points_possible = 0;
  double percent = 0;
  double pass_mark_percent = 0;
  bool passed = false;
  std::vector<std::string> reasons;  ///< why it failed, a sentence each, most serious first; empty if passed
  std::vector<StepResult> steps;
  std::vector<CriterionScore> criteria;  ///< of the whole exam
  MotionValues motion;                   ///< of the whole exam
};

}  // namespace insonate
