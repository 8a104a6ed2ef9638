#pragma once

#include <filesystem>
#include <string>

#include "app/session/session.h"
#include "devices/latency_histogram.h"

namespace insonate {

/// Measures the latency from a live tracker's report to the picture that is drawn from it.
class PictureLatency {
public:
  /// To be called when all pictures of a frame are drawn, at `drawn_s` (steady_now_s()).
  void add(const Session& session, double drawn_s);

  /// Returns a summary for people: one line with a bar for each millisecond that occurs.
  std::string text() const;
  /// Writes the histograms as CSV. Throws InputError if nothing was measured or the file cannot be written.
  void write(const std::filesystem::path& file) const;

private:
  LatencyHistogram to_frame_;    ///< from the report to the frame that uses its pose
  LatencyHistogram to_picture_;  ///< from the report to the pictures drawn from it
};

}  // namespace insonate
