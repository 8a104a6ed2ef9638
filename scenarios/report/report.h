#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenarios/result.h"
#include "scenarios/runner.h"

namespace insonate {

/// A picture in the report, shown beside the scores of its step.
struct ReportPicture {
  enum class Kind {
    best,      ///< the learner's picture at the best moment of the hold
    reference  ///< the picture of the step's reference view
  };
  std::size_t step = 0;  ///< counted from 0
  Kind kind = Kind::best;
  std::string png;
};

/// What an instructor has written about the attempt.
struct ReportComment {
  std::string author;   ///< an opaque id; empty if the author is not named
  std::string written;  ///< time
  std::string text;
};

/// The attempt that a report describes. Empty texts are left out.
struct ReportSubject {
  std::string learner;
  std::string attempt;   ///< number of the attempt
  std::string finished;  ///< time of the end
  std::vector<ReportPicture> pictures;
  std::vector<ReportComment> comments;
};

/// Returns the result as one HTML page that needs no other files and prints well. It contains the verdict and its
/// reasons, a summary of each step, the comments, and each criterion's value, limits, points and reason beside the
/// pictures. It also shows the course of the pictures and of the probe over time and in space, and the inputs of the
/// score. The same result, trace and subject produce the same bytes.
std::string report_html(const ExamResult& result, std::span<const TracePoint> trace, const ReportSubject& subject = {});

}  // namespace insonate
