#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/probe_sample.h"

namespace insonate {

/// The plan of a scan: the TOML text that `insonate-make-log` turns into a log. Each field is a key of the same name.
/// assets/logs/ruq_good.toml is an example.

/// `[[move]]`: the hand moves to a place and rests there. The place is a reference view of the scenario's case, offset
/// by the operator's error in the reference probe's frame.
struct PlannedMove {
  std::string view;
  double lateral_mm = 0;    ///< along the skin towards the marker, -300 to 300
  double elevation_mm = 0;  ///< along the skin across the plane, -300 to 300
  double tilt_deg = 0;      ///< as in scenarios/metrics/view_meter.h, -90 to 90
  double rock_deg = 0;
  double rotation_deg = 0;
  double lift_mm = 0;     ///< distance back from the pressed-in face, 0 to 300
  double seconds = 1;     ///< duration of the reach, 0.1 to 60
  double overshoot = 0;   ///< overshoot as a share of the path, 0 to 1
  int corrections = 0;    ///< small moves until the place is reached, 0 to 10
  double search_deg = 0;  ///< fanning to both sides before the rest, 0 to 60
  double search_s = 0;    ///< duration of the fanning, 0 to 60
  double rest_s = 0.5;    ///< 0 to 60
  /// Actions while the hand rests, with a pause before each. They are in the log's form ("freeze", "depth 120", "answer
  /// :yes"; scenarios/action.h), or one of these, which need the picture:
  ///   "caliper_on SLOT STRUCTURES ALONG ERROR_MM [LANDMARK]"  from edge to edge of structures (joined by '+') in the
  ///       picture, along "depth", "lateral" or "longest", too long by the error; of the part at its middle or landmark
  ///   "point_at LANDMARK ERROR_MM"                            at the landmark, with the error towards the marker's
  ///   side "label_at STRUCTURE"                                    its name, on it
  std::vector<std::string> doing;  ///< do = [...]
  double pause_s = 0.7;            ///< 0.1 to 20
};

/// `[[loss]]`: the tracker loses the probe.
struct PlannedLoss {
  double at_s = 0;
  double for_s = 0;
  PoseStatus status = PoseStatus::missing;  ///< status = "MISSING", "OUT_OF_VIEW", "OUT_OF_VOLUME" or "INVALID"
};

/// The whole plan.
struct LogPlan {
  std::filesystem::path scenario;   ///< names the case; path relative to the plan
  std::uint32_t scenario_seed = 0;  ///< selects the scenario's variant
  std::uint32_t seed = 1;           ///< of the hand
  double rate_hz = 40;              ///< of the tracker, 10 to 250
  double press_mm = 7;              ///< depth by which the face is pressed in, 0 to 20
  double unsteadiness_mm = 0.8;     ///< slow drift of a resting hand, 0 to 20
  double unsteadiness_deg = 0.8;    ///< 0 to 20
  double tremor_mm = 0.15;          ///< amplitude at 8 to 12 Hz, 0 to 5
  double noise_mm = 0.08;           ///< of the tracker, standard deviation along each axis, 0 to 5
  double noise_deg = 0.05;          ///< 0 to 5
  std::vector<PlannedMove> moves;   ///< the log begins at the first one
  std::vector<PlannedLoss> losses;
};

/// Reads a plan. Throws InputError.
LogPlan read_log_plan(const std::filesystem::path& file);

}  // namespace insonate
