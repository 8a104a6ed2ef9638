#pragma once

#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/probe/probe.h"

namespace insonate::view {

/// An ultrasound picture and its pose in the patient.
struct UltrasoundPlane {
  const gl::Texture* image =
      nullptr;             ///< as gl::Simulator::image() returns it, alpha is 0 outside the fan; null for none
  long image_version = 0;  ///< changes whenever the pixels change: gl::Simulator::image_version()
  ImageGeometry geometry;  ///< places its pixels in the probe's plane
  Probe probe;             ///< the probe to draw
  Pose patient_from_probe;
};

}  // namespace insonate::view
