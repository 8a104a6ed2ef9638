#pragma once

#include <optional>
#include <string>

#include "scenarios/action.h"
#include "scenarios/scenario.h"
#include "sim/core/pose.h"
#include "sim/volume/case.h"

namespace insonate {

/// The ultrasound machine as the learner's actions have set it: what a step is told of knobs and of the frozen picture.
struct Machine {
  std::string probe;  ///< a name known to find_probe()
  double depth_mm = 160;
  double frequency_mhz = 3.5;
  double gain_db = 0;
  bool frozen = false;
  std::optional<Pose> frozen_at;  ///< of the picture that stands still, while there is one

  /// The limits of a machine's depth, mm.
  static constexpr double kLeastDepth_mm = 30, kMostDepth_mm = 240;

  /// Takes a probe with its own depth and frequency; an unknown one changes nothing.
  void choose(const std::string& name);
  /// @param last_valid  the pose of the last valid sample, which a picture freezes at
  void apply(const Action& action, const std::optional<Pose>& last_valid);
};

/// How the machine is set when an exam begins: for the first view that a step names, its probe with the view's depth
/// as far as the machine goes; without one, the first probe there is.
Machine starting_machine(const Scenario& scenario, const Case& subject);

}  // namespace insonate
