#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

#include "sim/core/grid.h"
#include "sim/view/body/ct_volume_style.h"
#include "sim/view/body/orbit_camera.h"

namespace insonate::view {

/// The volume view's march through the CT, in double precision and plain loops, without leaps and without an end to
/// rays that are opaque: the measure of the shader. It draws neither plane nor probe, and the CT as it is, with the
/// table. Samples begin where the ray meets the CT, as if style.jittered were off.
class CtReference {
public:
  /// @param ct        must outlive the object
  /// @param step_mm   between samples; the style's own step is not used
  CtReference(const Volume<std::int16_t>& ct, const CtVolumeStyle& style, const OrbitCamera& camera, int width,
              int height, double step_mm);

  /// Returns colour times opacity, and opacity, of what lies along the ray through a point of the picture, from
  /// `begin_mm` to `end_mm` from the eye.
  /// @param x, y  in pixels, (0, 0) at the top left corner
  glm::dvec4 layer(double x, double y, double begin_mm, double end_mm) const;

  /// Returns the colour of the picture at a point: the whole ray over the background.
  glm::dvec3 colour(double x, double y) const;
  /// Returns the background's colour at a point of the picture.
  glm::dvec3 background(double x, double y) const;

  /// Returns the unit vector from the eye through a point of the picture.
  glm::dvec3 direction(double x, double y) const;
  const glm::dvec3& eye() const { return eye_; }

private:
  double hounsfield(const glm::dvec3& patient) const;
  glm::dvec3 gradient(const glm::dvec3& patient) const;
  glm::dvec2 light(const glm::dvec3& patient, const glm::dvec3& view) const;

  const Volume<std::int16_t>& ct_;
  Volume<std::int16_t> smooth_;
  CtVolumeStyle style_;
  TransferTable table_;
  double step_mm_;
  double width_, height_;
  glm::dvec3 eye_, right_, down_, into_;
};

}  // namespace insonate::view
