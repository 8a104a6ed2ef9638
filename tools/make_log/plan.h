#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/pose_sample.h"

namespace insonate {

/// How a scan goes, as a person would describe it: the TOML text that `insonate-make-log` turns into a log. Each field
/// is a key of the same name. assets/logs/ruq_good.toml is an example.

/// `[[move]]`: the hand goes to a place and rests there. The place is a reference view of the scenario's case, off by
/// what the operator gets wrong, in the reference probe's frame.
struct PlannedMove {
  std::string view;
  double lateral_mm = 0;    ///< along the skin towards the marker, -300 to 300
  double elevation_mm = 0;  ///< along the skin across the plane, -300 to 300
  double tilt_deg = 0;      ///< as in scenarios/metrics/view_meter.h, -90 to 90
  double rock_deg = 0;
  double rotation_deg = 0;
  double lift_mm = 0;     ///< back from where the face is pressed in, 0 to 300
  double seconds = 1;     ///< of the reach, 0.1 to 60
  double overshoot = 0;   ///< share of the way by which the reach goes too far, 0 to 1
  int corrections = 0;    ///< small moves until the place is met, 0 to 10
  double search_deg = 0;  ///< fanning to both sides before the rest, 0 to 60
  double search_s = 0;    ///< how long the fanning takes, 0 to 60
  double rest_s = 0.5;    ///< 0 to 60
  /// What the hand does while it rests, a pause before each. Actions as a log keeps them ("freeze", "depth 120",
  /// "answer :yes"; scenarios/action.h), or one that needs the picture:
  ///   "caliper_on SLOT STRUCTURES ALONG ERROR_MM [LANDMARK]"  from edge to edge of structures (joined by '+') in the
  ///       picture, along "depth", "lateral" or "longest", too long by the error; of the part at its middle or landmark
  ///   "point_at LANDMARK ERROR_MM"                            at where the landmark lies, too far to the marker's side
  ///   "label_at STRUCTURE"                                    its name, on it
  std::vector<std::string> doing;  ///< do = [...]
  double pause_s = 0.7;            ///< 0.1 to 20
};

/// `[[loss]]`: the tracker does not see the probe.
struct PlannedLoss {
  double at_s = 0;
  double for_s = 0;
  PoseStatus status = PoseStatus::missing;  ///< status = "MISSING", "OUT_OF_VIEW", "OUT_OF_VOLUME" or "INVALID"
};

struct LogPlan {
  std::filesystem::path scenario;   ///< gives the case; relative to the plan
  std::uint32_t scenario_seed = 0;  ///< draws the scenario's variant
  std::uint32_t seed = 1;           ///< of the hand
  double rate_hz = 40;              ///< of the tracker, 10 to 250
  double press_mm = 7;              ///< how deep the face is pressed in, 0 to 20
  double unsteadiness_mm = 0.8;     ///< slow wandering of a hand that rests, 0 to 20
  double unsteadiness_deg = 0.8;    ///< 0 to 20
  double tremor_mm = 0.15;          ///< amplitude at 8 to 12 Hz, 0 to 5
  double noise_mm = 0.08;           ///< of the tracker, standard deviation along each axis, 0 to 5
  double noise_deg = 0.05;          ///< 0 to 5
  std::vector<PlannedMove> moves;   ///< the first is where the log begins
  std::vector<PlannedLoss> losses;
};

/// Throws InputError.
LogPlan read_log_plan(const std::filesystem::path& file);

}  // namespace insonate
