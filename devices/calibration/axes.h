#pragma once

#include <glm/vec3.hpp>

#include <string>

#include "devices/calibration/outcome.h"
#include "sim/core/pose.h"

namespace insonate {

/// What has to change its sign for a tracker to move as hands do: +1 or -1 for each coordinate of the position and for
/// each of the quaternion's x, y and z. Public drivers of one device disagree on such signs (DEVICES).
struct AxisSigns {
  glm::dvec3 position{1};
  glm::dvec3 quaternion{1};

  Pose apply(const Pose& pose) const;
  bool none() const { return position == glm::dvec3(1) && quaternion == glm::dvec3(1); }
  /// "mirrored: the position's x; the quaternion's y and z", or "no axis is mirrored".
  std::string words() const;
};

/// The probe moved straight, without being turned meanwhile.
struct StraightMove {
  Pose from, to;  ///< tracker_from_sensor, mm
};

/// Four moves of 100 mm or so. Nothing needs to be known of where the tracker's base stands or how the sensor sits on
/// the probe.
struct AxesMoves {
  StraightMove right;    ///< the probe stands upright, its marker to the patient's right; moved to the right
  StraightMove up;       ///< held as before; moved up, away from the table
  StraightMove to_head;  ///< still upright, turned so that the marker points to the head; moved to the head
  StraightMove lying;    ///< laid over so that the marker points up; moved up
};

struct AxesFinding {
  AxisSigns signs;
  /// The largest angle, degrees, by which the moves then disagree: towards the marker was always the same direction of
  /// the probe, and so was up while it stood upright. A hand leaves 5 to 15.
  double misfit_deg = 0;
};

inline constexpr double kLeastMoveMm = 50;
inline constexpr double kMostAxesMisfitDeg = 30;

/// Finds which signs make the four moves agree, all 40 possibilities compared (the position's coordinates one at a
/// time or all, as a hemisphere jump leaves them; the quaternion's in any combination). No sign changes where the moves
/// agree without; else the fewest that make them agree. Several possibilities may differ only by how base and sensor
/// are turned, which later steps find anyway: then it does not matter which. Refused when a move is too short, when
/// moves are not at right angles to each other, or when no signs make them agree.
Outcome<AxesFinding> check_axes(const AxesMoves& moves);

}  // namespace insonate
