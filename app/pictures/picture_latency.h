#pragma once

#include <filesystem>
#include <string>

#include "app/session/session.h"
#include "devices/latency_histogram.h"

namespace insonate {

/// How long a live tracker's reports take to the picture that is made of them.
class PictureLatency {
public:
  /// To be called when a frame's pictures are drawn, all of them, at `drawn_s` (steady_now_s()).
  void add(const Session& session, double drawn_s);

  /// For people; a line and a bar for each millisecond in use.
  std::string text() const;
  /// Writes the histograms as CSV. Throws InputError when nothing was measured or the file cannot be written.
  void write(const std::filesystem::path& file) const;

private:
  LatencyHistogram to_frame_;    ///< from the report to the frame that asks for the pose
  LatencyHistogram to_picture_;  ///< from the report to the pictures of it
};

}  // namespace insonate
