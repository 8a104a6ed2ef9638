#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <string>

#include "devices/calibration/outcome.h"
#include "sim/core/pose.h"

namespace insonate {

/// Sign changes that make a tracker's poses move as a hand does: +1 or -1 for each coordinate of the position and for
/// each of the quaternion's x, y and z. Public drivers of one device disagree on such signs.
struct AxisSigns {
  glm::dvec3 position{1};
  glm::dvec3 quaternion{1};

  Pose apply(const Pose& pose) const;
  bool none() const { return position == glm::dvec3(1) && quaternion == glm::dvec3(1); }
  /// Returns "mirrored: the position's x; the quaternion's y and z", or "no axis is mirrored".
  std::string words() const;
};

/// A straight move of the probe without rotation.
struct StraightMove {
  Pose from, to;  ///< tracker_from_sensor, mm
};

/// Four moves of about 100 mm. Neither the placement of the tracker's base nor of the sensor on the probe has to be
/// known.
struct AxesMoves {
  StraightMove right;    ///< the probe stands upright, marker to the patient's right; moved to the right
  StraightMove up;       ///< held as before; moved up, away from the table
  StraightMove to_head;  ///< still upright, rotated so that the marker points to the head; moved to the head
  StraightMove lying;    ///< laid on its side so that the marker points up; moved up
};

/// How the probe is held at the start of a move, and which way it goes: directions in the patient (LPS).
struct AskedMove {
  glm::dvec3 marker, beam, way;
};

/// Returns the moves that a set-up asks for, in the order of AxesMoves.
const std::array<AskedMove, 4>& asked_moves();

/// The result of check_axes().
struct AxesFinding {
  AxisSigns signs;
  /// The largest angle (degrees) by which the moves disagree with these signs. The direction towards the marker must be
  /// the same in the probe's frame in all moves, and so must the direction up while the probe stood upright. Moves by
  /// hand leave 5 to 15.
  double misfit_deg = 0;
};

inline constexpr double kMinMove_mm = 50;
inline constexpr double kMaxAxesMisfit_deg = 30;

/// Finds the signs that make the four moves agree, by comparing all 40 combinations: the position's coordinates one at
/// a time or all together, as a hemisphere jump leaves them, and the quaternion's in any combination. If the moves
/// agree without a change, no sign changes; else the combination with the fewest changes that makes them agree is used.
/// Several combinations may differ only in the orientation of base and sensor, which later steps determine anyway; then
/// the choice does not matter. Refused if a move is too short, if the moves are not at right angles to each other, or
/// if no signs make them agree.
Outcome<AxesFinding> check_axes(const AxesMoves& moves);

}  // namespace insonate
