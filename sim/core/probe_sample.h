#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "sim/core/pose.h"

namespace insonate {

/// How a tracker rates a sample, with the names that IGSIO/PLUS uses in sequence files. Only `ok` samples carry a
/// usable pose.
enum class PoseStatus { ok, missing, out_of_view, out_of_volume, switched, invalid, unknown };

std::string_view to_string(PoseStatus status);

/// Why a filter between the tracker and its user has removed a sample's pose.
enum class Rejection {
  none,
  jump,        ///< the motion is too fast for a hand
  mirror,      ///< a magnetic tracker reports the sensor's mirror image in the other hemisphere
  distortion,  ///< the tracker grades its own field as worse than the limit
};

std::string_view to_string(Rejection rejection);

/// One reading of the tracked probe. Devices produce samples, scenarios score them, the simulator shows them.
struct ProbeSample {
  double time_s = 0;  ///< on the tracker's own clock, strictly rising within a run
  PoseStatus status = PoseStatus::unknown;
  Pose patient_from_probe;    ///< meaningful only when status is ok
  std::uint32_t buttons = 0;  ///< bit b is set while button b is held
  /// Distortion of a magnetic tracker's field by metal at the sensor, as the tracker itself grades it. 0 is a clean
  /// field; a Viper grades up to 255. Empty if the tracker gives no grade.
  std::optional<std::uint32_t> distortion{};
  Rejection rejected = Rejection::none;  ///< if not none, the status is invalid
};

}  // namespace insonate
