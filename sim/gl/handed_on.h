#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "sim/core/image.h"
#include "sim/gl/objects.h"

/// What one stage hands to the next, kept as sim/shaders/shared/handed_on.glsl says.
namespace insonate::gl {

/// What tells the shaders.
std::pair<std::string, std::string> handed_on_define(bool half_floats);

/// Room for pairs and for fours of numbers. Throws DeviceRefused.
TexelBuffer handed_on_pairs(bool half_floats, std::size_t count);
TexelBuffer handed_on_fours(bool half_floats, std::size_t count);

/// What has been written there, each of the four as an image. Waits for the device.
/// @param width   samples a line, @param height  lines
std::array<Image<float>, 4> read_scan(const TexelBuffer& scan, bool half_floats, int width, int height);
std::array<Image<float>, 4> read_echoes(const TexelBuffer& echoes, bool half_floats, int width, int height);

}  // namespace insonate::gl
