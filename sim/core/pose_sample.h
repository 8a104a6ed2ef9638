#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "sim/core/pose.h"

namespace insonate {

/// What a tracker says of a sample, as IGSIO/PLUS name it in sequence files. Only `ok` samples carry a usable pose.
enum class PoseStatus { ok, missing, out_of_view, out_of_volume, switched, invalid, unknown };

std::string_view to_string(PoseStatus status);

/// Why a filter between the tracker and whoever uses it has taken a sample's pose away.
enum class Rejection {
  none,
  jump,        ///< no hand moves like that
  mirror,      ///< a magnetic tracker takes the sensor for its mirror image in the other hemisphere
  distortion,  ///< the tracker itself grades its field worse than the limit
};

std::string_view to_string(Rejection rejection);

/// One reading of the tracked probe. Devices make them, scenarios score them, the simulator shows them.
struct PoseSample {
  double time_s = 0;  ///< on the tracker's own clock, strictly rising within a run
  PoseStatus status = PoseStatus::unknown;
  Pose patient_from_probe;    ///< meaningful only when status is ok
  std::uint32_t buttons = 0;  ///< bit b is set while button b is held
  /// How badly metal bends a magnetic tracker's field where the sensor is, as the tracker itself grades it: 0 is a
  /// clean field, a Viper goes up to 255. Empty where the tracker does not say.
  std::optional<std::uint32_t> distortion{};
  Rejection rejected = Rejection::none;  ///< the status is invalid then
};

}  // namespace insonate
