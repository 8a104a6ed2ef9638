#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/registration/live_session.h"
#include "sim/core/image.h"
#include "sim/gl/objects.h"
#include "sim/imaging/simulator.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"

namespace insonate {

/// Draws received images as they lie in the plane of their fan, black outside it. Where each pixel comes from is worked
/// out once, because images of one stream lie alike.
class FanView {
public:
  /// @param pixel_from_plane, width, height  of the images
  FanView(const Probe& probe, double depth_mm, const ImageGeometry& geometry, const glm::dmat3& pixel_from_plane,
          int width, int height);

  bool fits(const LiveSession::Shown& shown) const;
  /// @param image  of the constructor's size
  Image<Rgba8> of(const Image<std::uint8_t>& image) const;

private:
  struct Source {
    int at = -1;                             // index of the pixel up left; -1: black
    std::array<std::uint16_t, 4> weights{};  // of it and its neighbours right, below, and below right; their sum is 256
  };
  glm::dmat3 pixel_from_plane_;
  int width_, height_, shown_width_, shown_height_;
  std::vector<Source> sources_;
};

/// Draws the three pictures of a live registration on the pixels of one fan: the received image, the image that model S
/// simulates at the estimate, and both blended. The probe's marker is on the left. Needs an OpenGL context that is
/// current from construction to destruction.
class RegistrationPictures {
public:
  static constexpr int kWidth = 384, kHeight = 288;

  /// Uploads the patient. Throws what gl::Simulator throws.
  RegistrationPictures(const AcousticVolume& volume, const TissueTable& table);

  /// Draws the newest image at the estimate, unless both are those of the call before. Returns whether it drew. Does
  /// nothing before the session knows the probe.
  bool draw(const LiveSession& session);

  const gl::Texture& received() const { return received_; }
  const gl::Texture& simulated() const { return simulated_; }
  const gl::Texture& blended() const { return blended_; }
  /// Returns how often all three have been drawn.
  long drawn() const { return drawn_; }

private:
  gl::Simulator simulator_;
  gl::Texture received_, simulated_, blended_;
  std::optional<FanView> view_;  // of the next two
  Probe probe_;
  double depth_mm_ = 0;
  long of_image_ = -1, drawn_ = 0;
  glm::dmat4 at_{0.0};
};

/// Returns the first image in orange and the second in blue. Where both are bright it is white.
Image<Rgba8> blend(const Image<Rgba8>& orange, const Image<Rgba8>& blue);

}  // namespace insonate
