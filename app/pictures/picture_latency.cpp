#include "app/pictures/picture_latency.h"

#include "sim/core/input_error.h"
#include "sim/files/files.h"

namespace insonate {

void PictureLatency::add(const Session& session, double drawn_s) {
  const std::optional<PoseEstimate>& answer = session.pose_estimate();
  // A picture that stands still does not come from a new report.
  if (!answer || answer->how == PoseAnswer::none || session.lost_for_s() || session.machine().frozen) return;
  to_frame_.add(answer->age_s);
  to_picture_.add(answer->age_s + drawn_s - session.now_s());
}

std::string PictureLatency::text() const {
  return "report to frame: " + to_frame_.text() + "report to picture: " + to_picture_.text();
}

void PictureLatency::write(const std::filesystem::path& file) const {
  if (to_frame_.count() == 0)
    throw InputError(file.string(), "--latency", "no pose of a live tracker was drawn",
                     "name one, as in '--tracker synthetic:1?live=1'");
  write_file(file, to_csv({"report_to_frame", "report_to_picture"}, {to_frame_, to_picture_}));
}

}  // namespace insonate
