#pragma once

#include <deque>
#include <optional>
#include <string>

#include "app/pictures/pictures.h"
#include "app/session/session.h"
#include "sim/core/image.h"
#include "sim/gl/readback.h"

namespace insonate {

/// An ultrasound picture as it was drawn, copied to main memory.
struct DrawnPicture {
  Image<std::uint8_t> grey;  ///< row 0 nearest to the probe, columns increasing towards the marker
  ImageGeometry geometry;    ///< the picture's position in the probe's plane
  Pose patient_from_probe;
  double time_s = 0;  ///< on the clock of the session's source
  int attempt = 0;    ///< of the session
  std::string probe;  ///< its name
  double depth_mm = 0;
  bool frozen = false;  ///< it was drawn anew although it is frozen, as for another gain
};

/// Reads the ultrasound back, each picture once and without waiting for the graphics card. Needs its OpenGL context
/// current.
class PictureReader {
public:
  /// Requests the picture if it differs from the last one requested. To be called once per frame after
  /// Pictures::update(). Skips the picture if the graphics card is too far behind with earlier requests.
  void ask(const Session& session, const Pictures& pictures);

  /// Returns the oldest requested picture once it has arrived, else nothing.
  /// @param wait  whether to wait for it
  std::optional<DrawnPicture> take(bool wait);

  /// Requests the current picture again, for a client that has not seen it.
  void ask_again() { asked_version_ = -1; }
  /// Discards pending requests: they belong to another session.
  void forget();

private:
  gl::Readback readback_;
  std::deque<DrawnPicture> asked_;  ///< requested pictures, still without pixels
  long asked_version_ = -1;
};

}  // namespace insonate
