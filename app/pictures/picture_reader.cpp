#include "app/pictures/picture_reader.h"

#include <utility>

namespace insonate {

void PictureReader::ask(const Session& session, const Pictures& pictures) {
  const long version = pictures.ultrasound_version();
  if (!pictures.ultrasound() || !session.shown_pose() || version == asked_version_ || readback_.full()) return;
  asked_version_ = version;
  readback_.begin(*pictures.ultrasound());
  asked_.push_back(
      {{}, pictures.geometry(), *session.shown_pose(), session.source().clock_s(session.now_s()), session.attempt()});
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
