#pragma once

#include <string>

#include "scenarios/result.h"

namespace insonate {

/// Numbers as reports and screens show them, so that all of them say the same of one score.

/// With that many digits behind the point.
std::string fixed(double value, int decimals);

/// Points and percentages that a person wrote, with two digits behind the point at most: "2", "1.75".
std::string short_number(double value);

/// A metric's value with its unit: "12.4 mm", "82 %", "7".
std::string in_words(Metric metric, double value);

/// A structure's name as a person reads it: "right kidney".
std::string in_words(std::string name);

/// The percentage with one digit behind the point, or as many as keep a failed one below the pass mark: "79.96".
std::string percentage(const ExamResult& result);

}  // namespace insonate
