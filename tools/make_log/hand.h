#pragma once

#include <vector>

#include "scenarios/action.h"
#include "sim/core/probe_sample.h"
#include "sim/volume/case.h"
#include "tools/make_log/plan.h"

namespace insonate {

/// The samples and actions of a simulated log.
struct MadeLog {
  std::vector<ProbeSample> samples;
  ActionLog actions;  ///< by the samples' times
};

/// Simulates a hand that moves a probe over a case. It makes minimum-jerk reaches (Flash and Hogan 1985) that overshoot
/// and are corrected, fans, and rests with drift and tremor, while the face follows the skin. Then it simulates a
/// tracker with noise and losses. The same plan and case produce the same samples. Throws InputError if a view is not
/// in the case, if there is no skin under the probe, or if an action names something that the picture does not show.
MadeLog move_by_hand(const LogPlan& plan, const Case& subject);

}  // namespace insonate
