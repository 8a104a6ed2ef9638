#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenarios/result.h"
#include "scenarios/runner.h"

namespace insonate {

/// A picture to show in the report, beside the marks of its step.
struct ReportPicture {
  enum class Kind {
    best,      ///< the learner's, while the view was held best
    reference  ///< of the step's reference view
  };
  std::size_t step = 0;  ///< counted from 0
  Kind kind = Kind::best;
  std::string png;
};

/// Whose attempt a report tells of; texts that are empty are left out.
struct ReportSubject {
  std::string learner;
  std::string attempt;   ///< its number
  std::string finished;  ///< when
  std::vector<ReportPicture> pictures;
};

/// The result as one HTML page that needs no other file and prints well: the verdict and its reasons, each step at a
/// glance, each criterion's value, limits, points and why beside the pictures, how the pictures and the probe went over
/// time and in space, and what the score was made from. The same result, trace and subject give the same bytes.
std::string report_html(const ExamResult& result, std::span<const TracePoint> trace, const ReportSubject& subject = {});

}  // namespace insonate
