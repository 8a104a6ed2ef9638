#pragma once

#include <deque>
#include <optional>

#include "app/pictures/pictures.h"
#include "app/session/session.h"
#include "sim/core/image.h"
#include "sim/gl/readback.h"

namespace insonate {

/// The ultrasound as it was drawn, for those outside the graphics card.
struct DrawnPicture {
  Image<std::uint8_t> grey;  ///< row 0 nearest to the probe, columns towards the marker
  ImageGeometry geometry;    ///< how it lies in the probe's plane
  Pose patient_from_probe;
  double time_s = 0;  ///< on the clock of the session's source
  int attempt = 0;    ///< of the session
};

/// Reads the ultrasound back, each picture once and without waiting for the graphics card. Needs its OpenGL context
/// current.
class PictureReader {
public:
  /// To be called once a frame, behind Pictures::update(): asks for the picture if it is another than the last one.
  /// When the card is too far behind to be asked, that picture is left out.
  void ask(const Session& session, const Pictures& pictures);

  /// The oldest of those that were asked for, once it is there. @param wait  for it
  std::optional<DrawnPicture> take(bool wait);

  /// The picture that stands is asked for again, as somebody is there who has not seen it.
  void ask_again() { asked_version_ = -1; }
  /// Gives up what is under way: it is of another session.
  void forget();

private:
  gl::Readback readback_;
  std::deque<DrawnPicture> asked_;  ///< without their pixels
  long asked_version_ = -1;
};

}  // namespace insonate
