#include "sim/imaging/view_limits.h"

#include <cstdio>
#include <stdexcept>
#include <string>

namespace insonate::gl {
namespace {

void check_within(const char* simulator, const char* what, double value, double least, double most) {
  if (value >= least && value <= most) return;  // false for NaN
  char text[160];
  std::snprintf(text, sizeof text, "%s: %s is %g; give a number from %g to %g.", simulator, what, value, least, most);
  throw std::invalid_argument(text);
}

}  // namespace

void check_probe(const char* simulator, const Probe& probe, double depth_mm) {
  check_within(simulator, "the depth in mm", depth_mm, kMinViewDepth_mm, kMaxViewDepth_mm);
  check_within(simulator, "the number of scan lines", probe.lines, 1, 4096);
  check_within(simulator, "the widest aperture in mm", probe.aperture_mm, 1, 200);
  if (probe.kind == ProbeKind::curvilinear)
    check_within(simulator, "the face's radius in mm", probe.radius_mm, 5, 200);
  else
    check_within(simulator, "the face's width in mm", probe.width_mm, 5, 200);
  if (probe.kind != ProbeKind::linear)
    check_within(simulator, "the field of view in degrees", probe.field_of_view_deg, 5, 150);
}

void check_pose(const char* simulator, const Pose& patient_from_probe) {
  if (const auto why = why_not_rigid(patient_from_probe.matrix(), kMaxDistance_mm))
    throw std::invalid_argument(std::string(simulator) + ": the pose: " + *why);
}

}  // namespace insonate::gl
