#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/action.h"
#include "scenarios/scenario.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"
#include "sim/volume/case.h"

namespace insonate {

/// The ultrasound machine as actions have set it: its knobs and the frozen picture. Equal machines and poses give equal
/// pictures.
struct Machine {
  std::string probe;  ///< a name known to find_probe(); empty before one is chosen
  double depth_mm = 160;
  double frequency_mhz = 3.5;
  double gain_db = 0;
  double dynamic_range_db = kDynamicRange_db;
  std::array<double, Action::kTimeGainSliders>
      time_gain_db{};  ///< sliders near to far, on top of the machine's own compensation
  bool frozen = false;
  std::optional<Pose> frozen_at;  ///< pose of the frozen picture; empty if no valid sample came before

  static constexpr double kLeastDepth_mm = 30, kMostDepth_mm = 240;
  static constexpr double kLeastDynamicRange_db = 30, kMostDynamicRange_db = 90, kDynamicRange_db = 60;
  static constexpr double kMostGain_db = 30, kMostTimeGain_db = 20;  ///< either way from 0

  /// The probe that `probe` names. Throws std::logic_error before one is chosen.
  const Probe& transducer() const;
  /// Takes a probe with its own depth and frequency; an unknown one changes nothing.
  void choose(const std::string& name);
  /// Sets a knob, freezes or unfreezes; other actions change nothing. Depth, dynamic range and time gain are limited to
  /// the machine's ranges.
  /// @param last_valid  the pose of the last valid sample, which a picture freezes at
  void apply(const Action& action, const std::optional<Pose>& last_valid);
  bool operator==(const Machine&) const = default;
};

/// The actions that bring the knobs of one machine to those of another, in an order that does so.
std::vector<Action> actions_between(const Machine& from, const Machine& to);

/// How the machine is set when an exam begins: for the first view that a step names, its probe with the view's depth
/// as far as the machine goes; without one, the first probe there is.
Machine starting_machine(const Scenario& scenario, const Case& subject);

}  // namespace insonate
