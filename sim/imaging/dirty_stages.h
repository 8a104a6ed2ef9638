#pragma once

#include <optional>

#include "sim/imaging/stage.h"
#include "sim/model/settings.h"

namespace insonate::gl {

/// What a change of settings reaches of a picture. Settings that others leave unused, such as the focus of a beam that
/// has none, dirty nothing.
struct DirtyStages {
  std::optional<Stage> first;  ///< stage to run again, with those behind it; none when the picture stays as it is
  bool layout = false;         ///< the number of samples, planes or pixels
  bool beam = false;           ///< what the beam's windows hang on
};

DirtyStages dirty_stages(const Settings& before, const Settings& now);

/// The same of a sweep's volume, which uses neither the picture's size nor its smoothing.
struct DirtySweepStages {
  std::optional<SweepStage> first;
  bool layout = false;
  bool beam = false;
};

DirtySweepStages dirty_sweep_stages(const Settings& before, const Settings& now);

}  // namespace insonate::gl
