#pragma once

#include <cstdint>

#include "sim/gl/simulator.h"
#include "sim/probe/sweep.h"

namespace insonate {

/// A sweep as a volume of grey levels, 0 to 255, with -1 outside it.
///
/// Each plane's U (6) is taken on its lines, with gain and time gain but without the smoothing of pictures,
/// brought to the grid's voxels, and log-compressed there (7).
/// @param simulator  with the volume; its probe, settings and pose are set
/// @param grid       sides up to 512
Volume<std::int16_t> render_sweep(gl::Simulator& simulator, const Sweep& sweep, const Settings& settings,
                                  const Grid& grid);

}  // namespace insonate
