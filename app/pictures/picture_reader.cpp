#include "app/pictures/picture_reader.h"

#include <utility>

namespace insonate {

void PictureReader::ask(const Session& session, const Pictures& pictures) {
  const long version = pictures.ultrasound_version();
  if (!pictures.ultrasound() || !session.shown_pose() || version == asked_version_ || readback_.full()) return;
  asked_version_ = version;
  readback_.begin(*pictures.ultrasound());
  const Machine& machine = session.machine();
  DrawnPicture& picture = asked_.emplace_back();
  picture.geometry = pictures.geometry();
  picture.patient_from_probe = *session.shown_pose();
  picture.time_s = session.source().clock_s(session.now_s());
  picture.attempt = session.attempt();
  picture.probe = machine.probe;
  picture.depth_mm = machine.depth_mm;
  picture.frozen = machine.frozen;
}

std::optional<DrawnPicture> PictureReader::take(bool wait) {
  std::optional<Image<std::uint8_t>> grey = readback_.take(wait);
  if (!grey) return std::nullopt;
  DrawnPicture picture = std::move(asked_.front());
  asked_.pop_front();
  picture.grey = std::move(*grey);
  return picture;
}

void PictureReader::forget() {
  readback_.forget();
  asked_.clear();
  ask_again();
}

}  // namespace insonate
