#include "app/pictures/frame_times.h"

#include <epoxy/gl.h>

#include <cstdio>
#include <string>

#include "devices/live/steady_clock.h"
#include "sim/files/files.h"

namespace insonate {

void FrameTimes::begin(double now_s) {
  frames_.push_back({});
  frames_.back().begin_s = part_began_s_ = now_s;
}

void FrameTimes::end(FramePart part) {
  if (!parts_ || frames_.empty()) return;
  glFinish();
  const double now_s = steady_now_s();
  frames_.back().part_s[std::size_t(part)] += now_s - part_began_s_;
  part_began_s_ = now_s;
}

void FrameTimes::finish(double now_s, const Outcome& outcome) {
  frames_.back().end_s = now_s;
  frames_.back().outcome = outcome;
}

void FrameTimes::write(const std::filesystem::path& file) const {
  std::string text = "begin_s,end_s,new_picture,shown,pixels_drawn,quality,volumes,volume_scale";
  for (const char* part : kFrameParts) text += std::string(",") + part + "_ms";
  text += "\n";
  char cells[160];
  for (const Frame& frame : frames_) {
    std::snprintf(cells, sizeof cells, "%.6f,%.6f,%d,%d,%ld,%.3f,%ld,%d", frame.begin_s, frame.end_s,
                  int(frame.outcome.new_picture), int(frame.outcome.shown), frame.outcome.pixels_drawn,
                  frame.outcome.quality, frame.outcome.volumes, frame.outcome.volume_scale);
    text += cells;
    for (const double part_s : frame.part_s) {
      std::snprintf(cells, sizeof cells, ",%.3f", 1e3 * part_s);
      text += cells;
    }
    text += "\n";
  }
  write_file(file, text);
}

}  // namespace insonate
