#pragma once

#include <cstdint>

#include "sim/core/image.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/probe/probe.h"

/// From U to grey, in double precision: gains, log compression (7), persistence, the display filter
/// (sim/model/display_filter.h) and the grey map.
namespace insonate {

/// Returns gain and time gain at a share of the imaging depth, 0 to 1, as a factor on U.
double time_gain(const Settings& settings, double depth_share);

/// Returns grey after log compression (7) and the grey map: 255 at `level`, 0 if `echo` is 0 or lies the dynamic range
/// below `level`.
std::uint8_t grey_level(const Settings& settings, double echo, double level);

/// Returns grey behind the display filter and the grey map.
/// @param shown  Stages::shown
/// @param looks  how many have been compounded
Image<std::uint8_t> filtered_grey(const Image<double>& shown, const Image<std::uint8_t>& inside,
                                  const Settings& settings, double mm_per_pixel, int looks);

/// Fills `shown` and `grey` from `fused` and `inside`.
/// @param looks         how many have been compounded
/// @param frame_before  `shown` of the frame before; null for none
void show_reference(Stages<double>& stages, const Probe& probe, double depth_mm, const Settings& settings, int looks,
                    const Image<double>* frame_before = nullptr);

}  // namespace insonate
