#pragma once

#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/probe/probe.h"

namespace insonate::view {

/// An ultrasound picture and where it lies in the patient.
struct UltrasoundPlane {
  const gl::Texture* image =
      nullptr;             ///< null for none; as gl::Simulator::image() gives it; alpha is 0 outside the fan
  long image_version = 0;  ///< another number whenever the pixels changed: gl::Simulator::image_version()
  ImageGeometry geometry;  ///< how its pixels lie in the probe's plane
  Probe probe;             ///< whose shape is drawn
  Pose patient_from_probe;
};

}  // namespace insonate::view
