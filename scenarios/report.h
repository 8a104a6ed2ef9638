#pragma once

#include <span>
#include <string>

#include "scenarios/result.h"
#include "scenarios/runner.h"

namespace insonate {

/// A picture to show in the report.
struct ReportPicture {
  std::string caption;   ///< "Best frame, step 2"
  std::string data_uri;  ///< "data:image/png;base64,..."
};

/// The result as one HTML page that needs no other file and prints well: the verdict and its reasons, each criterion's
/// value, limits, points and why, how the pictures and the probe went over time, and what the score was made from.
/// The same result and trace give the same bytes.
std::string report_html(const ExamResult& result, std::span<const TracePoint> trace,
                        std::span<const ReportPicture> pictures = {});

}  // namespace insonate
