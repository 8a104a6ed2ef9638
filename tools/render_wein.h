#pragma once

#include <cstdint>
#include <string>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/wein_settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// One picture of model W, the marker (+x) on the right; on the graphics card, or by the reference without OpenGL.
/// @param file  what the person who gave the CT calls it
Image<std::uint8_t> render_wein(const std::string& file, const AcousticVolume& volume, const Probe& probe,
                                double depth_mm, const WeinSettings& settings, const Pose& patient_from_probe,
                                bool by_reference);

}  // namespace insonate
