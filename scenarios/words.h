#pragma once

#include <string>
#include <string_view>

#include "scenarios/result.h"

namespace insonate {

/// Formats numbers for reports and screens, so that all of them show the same figures for one score.

/// Returns the value with `decimals` digits after the point.
std::string fixed(double value, int decimals);

/// Returns points or a percentage that a person wrote, with at most two digits after the point: "2", "1.75".
std::string short_number(double value);

/// Returns a metric's value with its unit: "12.4 mm", "82 %", "7".
std::string in_words(Metric metric, double value);

/// Returns the sentence with no-break spaces between numbers and what follows them, so that no line ends between a
/// number and its unit.
std::string unbroken(std::string_view sentence);

/// Returns a metric's name for people who read its value. It says what 100 % is where a value can exceed it.
std::string title_of(Metric metric);

/// Returns what a fact of a step is, as a person reads it: "length, depth, width" for the three lengths of a volume.
/// @param name  of StepResult::facts
std::string title_of_fact(const std::string& name, const std::string& fact);

/// Returns a structure's name as a person reads it: "right kidney".
std::string in_words(std::string name);

/// Returns how a step ended: "view held".
std::string in_words(StepOutcome outcome);

/// What the word "critical" beside a criterion means.
inline constexpr const char* kCriticalMeans = "A critical criterion that earns nothing fails the exam.";

/// Returns a step's points: "2 of 3 points", and for one that was not done, that what was reached is scored. Returns
/// "does not count" for a warm-up and for a step without criteria.
std::string score_in_words(const StepResult& step);

/// Returns the percentage with one digit after the point. A failed result gets as many digits as keep it below the pass
/// mark, at most 12: "79.96".
std::string percentage(const ExamResult& result);

}  // namespace insonate
