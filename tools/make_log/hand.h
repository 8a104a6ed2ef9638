#pragma once

#include <vector>

#include "scenarios/action.h"
#include "sim/core/pose_sample.h"
#include "sim/volume/case.h"
#include "tools/make_log/plan.h"

namespace insonate {

/// Moves a probe over a case as a hand would: reaches of minimum jerk (Flash and Hogan 1985) that overshoot and are
/// corrected, fanning, rests with wandering and tremor, the face following the skin. Then looks at it as a tracker
/// would, with noise and losses. The same plan and case give the same samples.
/// Throws InputError when a view is not in the case, when there is no skin under the probe, or when what the hand is to
/// do names what the picture does not show.
struct MadeLog {
  std::vector<PoseSample> samples;
  ActionLog actions;  ///< by the samples' times
};
MadeLog move_by_hand(const LogPlan& plan, const Case& subject);

}  // namespace insonate
