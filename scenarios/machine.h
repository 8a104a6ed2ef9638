#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/action.h"
#include "scenarios/scenario.h"
#include "sim/core/pose.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "sim/volume/case.h"

namespace insonate {

/// State of the ultrasound machine: its settings and the frozen picture. Equal machines and poses produce equal
/// pictures.
struct Machine {
  std::string probe;  ///< a name known to find_probe(); empty before one is chosen
  double depth_mm = 160;
  double frequency_mhz = 3.5;
  double gain_db = 0;
  double dynamic_range_db = kUsualDynamicRange_db;
  std::array<double, Action::kTimeGainSliders>
      time_gain_db{};       ///< sliders from near to far, added to the machine's own compensation
  int steering_angles = 3;  ///< of compounding, odd; these four as in Settings, at rest as in with_usual_display()
  double persistence = 0.3, edge_enhancement = 0.5, speckle_reduction = 0;
  std::map<std::string, double> effects;  ///< of the model (sim/model/effects.h), those that practice has changed
  bool frozen = false;
  std::optional<Pose> frozen_at;  ///< pose of the frozen picture; empty if no valid sample came before

  static constexpr double kMinDepth_mm = 30, kMaxDepth_mm = 240;
  static constexpr double kMinDynamicRange_db = 30, kMaxDynamicRange_db = 90;
  static constexpr int kMaxSteeringAngles = 5;
  static constexpr double kMaxPersistence = 0.9, kMaxEdgeEnhancement = 2;
  static constexpr double kMaxGain_db = 30, kMaxTimeGain_db = 20;  ///< in both directions from 0

  /// Returns the probe that `probe` names. Throws std::logic_error before a probe is chosen.
  const Probe& transducer() const;
  /// Selects a probe and sets its own depth and frequency. An unknown name changes nothing.
  void choose(const std::string& name);
  /// Returns whether the machine ignores actions of this kind now: while a picture is frozen, those that decide which
  /// echoes are acquired: probe, depth, frequency, compounding and effects. A frozen picture is data. Gain, time gain
  /// and dynamic range act on what has been acquired, so they change a frozen picture too.
  bool refuses(ActionKind kind) const;
  /// Applies a setting, a freeze or an unfreeze; other actions, and those it refuses, change nothing. Depth, dynamic
  /// range and time gain are clamped to the machine's ranges.
  /// @param last_valid  pose of the last valid sample, at which the picture freezes
  void apply(const Action& action, const std::optional<Pose>& last_valid);
  bool operator==(const Machine&) const = default;
};

/// Returns the actions that change the settings of `from` to those of `to`, in an order in which they work. A picture
/// that is frozen in `from` is let go for them, and the one of `to` is frozen last.
std::vector<Action> actions_between(const Machine& from, const Machine& to);

/// Returns the machine's settings at the start of an exam. They are the probe and depth of the first view that a step
/// names, with the depth clamped to the machine's range. Without such a view, they are those of the first available
/// probe.
Machine starting_machine(const Scenario& scenario, const Case& subject);

}  // namespace insonate
