#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "sim/core/image.h"
#include "sim/gl/filter_error.h"
#include "sim/gl/headless_context.h"
#include "sim/gl/readback.h"
#include "sim/imaging/simulator.h"
#include "sim/tissue/tissue.h"
#include "sim/volume/case.h"
#include "tools/dataset/shots.h"

namespace insonate {

/// Draws the pictures of shots, on an OpenGL context of its own. While one is being drawn, the one before is read back.
/// Where the device's own filter is coarse, volumes are filtered exactly, so that all devices draw the same.
class PictureMaker {
public:
  /// Receives a shot and its grey picture, columns towards the marker.
  using Take = std::function<void(Shot&& shot, Image<std::uint8_t>&& grey)>;

  /// Sets the patient of the following shots. Throws InputError if the device cannot hold the CT.
  /// @param source     of the case, in error sentences
  /// @param structure  as in make_acoustic_volume()
  void set_patient(const std::string& source, const Case& subject, const TissueTable& tissues, bool structure);

  /// Draws a shot, and calls `take` for those before it that are done. A picture depends on its shot and the patient
  /// alone, not on what was drawn before.
  void draw(Shot&& shot, const Take& take);
  /// Calls `take` for all shots that were not taken yet.
  void finish(const Take& take);

  std::string device() const { return gl::device_description(); }

private:
  void take_next(const Take& take);

  gl::HeadlessContext context_;
  const bool has_coarse_filter_ = gl::measure_filter().is_coarse();
  gl::Simulator simulator_;
  gl::Readback readback_;
  std::deque<Shot> under_way_;
};

}  // namespace insonate
