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

/// A criterion's mark and why.
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

enum class StepOutcome {
  held,        ///< the view was held for the time asked
  done,        ///< what a step of another kind asks for was done
  went_on,     ///< the learner ended it before that
  timed_out,   ///< its time limit, or the exam's, came first
  scan_ended,  ///< there were no more samples
  skipped,     ///< the exam went on past it, because of how another step went
  not_reached  ///< the exam ended before it
};

/// Whether what the step asks for was done.
inline bool is_done(StepOutcome outcome) {
  return outcome == StepOutcome::held || outcome == StepOutcome::done;
}

struct StepResult {
  std::string title;
  std::string kind;
  bool holds_view = false;  ///< it is done by holding a view; known while the runner decides, and not stored
  bool counts = true;       ///< false for a warm-up: its marks earn nothing
  std::string view;
  StepOutcome outcome = StepOutcome::not_reached;
  double start_s = 0;  ///< since the start of the exam
  double end_s = 0;
  std::optional<double> judged_from_s;  ///< the picture is judged from here to judged_to_s
  std::optional<double> judged_to_s;
  std::optional<ViewValues> judged;  ///< means of the unsigned values over that time; empty without a valid sample
  double longest_hold_s = 0;
  std::vector<std::pair<Metric, double>> values;  ///< what the step's kind measures besides, as far as it could
  std::vector<std::pair<std::string, std::string>> facts;  ///< what else is to be known: "answer", "a stone"
  MotionValues motion;
  std::vector<CriterionScore> criteria;
  int hints_taken = 0;
  double hint_cost = 0;  ///< taken from what the marks earn, which does not go below 0

  double earned() const;         ///< points of the marks without what the hints cost
  double lost_to_hints() const;  ///< no more than the marks earned
  /// What `values` has of a metric.
  std::optional<double> value(Metric step_metric) const {
    for (const auto& [metric, measured] : values)
      if (metric == step_metric) return measured;
    return std::nullopt;
  }
};

/// What a score was made from, so that it can be made again.
struct Provenance {
  std::string program_version;
  int scoring_version = 0;          ///< ExamResult::kScoringVersion of that program
  std::optional<AttemptMode> mode;  ///< empty when whoever kept the score did not say
  std::string scenario;             ///< file name
  std::string scenario_digest;
  std::string case_name;
  std::string case_digest;
  std::vector<std::pair<std::string, std::string>> phantom_options;
  std::uint32_t seed = 0;  ///< which drew the variant
  std::string variant;     ///< empty when the scenario has none
  std::string log;         ///< file name; empty for a live scan that was not recorded
  std::string log_digest;
  std::string log_transform;  ///< the one that was taken for the probe's: "ProbeToPatient"
};

struct ExamResult {
  /// Raised whenever the same samples could get another score.
  static constexpr int kScoringVersion = 3;

  std::string title;
  Provenance provenance;
  bool complete = false;  ///< every step ended, or the time or the samples did; else the marks so far
  double points = 0;
  double points_possible = 0;
  double percent = 0;
  double pass_mark_percent = 0;
  bool passed = false;
  std::vector<std::string> reasons;  ///< of failing, one sentence each, the gravest first; empty when passed
  std::vector<StepResult> steps;
  std::vector<CriterionScore> criteria;  ///< of the whole exam
  MotionValues motion;                   ///< of the whole exam
};

}  // namespace insonate
