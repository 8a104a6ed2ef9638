#pragma once

#include <optional>

#include "sim/imaging/stage.h"
#include "sim/model/settings.h"

namespace insonate::gl {

/// Which stages a change of settings invalidates for a picture. Settings that others leave unused, such as the focus of
/// a beam without one, invalidate nothing.
struct DirtyStages {
  std::optional<Stage> first;  ///< first stage to run again, with all behind it; empty if the picture does not change
  bool layout = false;         ///< the number of samples, slice planes or pixels changed
  bool beam = false;           ///< something that the beam's windows depend on changed
};

/// Returns what a change of settings from `before` to `now` invalidates.
DirtyStages dirty_stages(const Settings& before, const Settings& now);

/// The same for a sweep's volume, which uses neither the picture's size nor its smoothing.
struct DirtySweepStages {
  std::optional<SweepStage> first;
  bool layout = false;
  bool beam = false;
};

/// Returns what a change of settings from `before` to `now` invalidates in a sweep's volume.
DirtySweepStages dirty_sweep_stages(const Settings& before, const Settings& now);

}  // namespace insonate::gl
