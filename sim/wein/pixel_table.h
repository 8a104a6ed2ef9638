#pragma once

#include <glm/vec4.hpp>

#include <cstddef>
#include <span>
#include <vector>

#include "sim/core/image.h"
#include "sim/gl/objects.h"
#include "sim/imaging/fan_layout.h"
#include "sim/probe/probe.h"

/// The pixels that model W's stages convert (wein/wein_scan.glsl), divided among their invocations.
namespace insonate::gl {

/// The place of a pixel among the scan lines. x: the index of the sample in front of it in a scan, -1 outside the fan.
/// y, z: the fractions to the next sample and to the next line, as a float's bits. w: depends on the stage.
using PixelPlace = glm::ivec4;

/// Returns the place of each pixel of the fan's picture, row by row.
/// @param row_samples  from one line of the scan to the next, at least a line's samples
std::vector<PixelPlace> places_in_scan(const FanLayout& fan, const ScanLines& lines, int row_samples);

/// A table with one column per invocation and one row per step. The columns fill whole work groups.
struct PixelTable {
  std::size_t columns = 0;
  std::size_t pixels = 0;  ///< inside the fan; other entries fill up words and shorter columns
  TexelBuffer places;

  explicit operator bool() const { return columns > 0; }
};

/// Pixels per word of a picture's grid; a word is stored at once.
inline constexpr int kWordPixels = 4;

/// Returns the table for wein_picture.comp: the words of a picture that the fan touches, each as its pixels in
/// sequence. The first pixel of a word gives the word's place: its row, and its index in the row.
/// @param group  invocations per work group, 1 or more
PixelTable picture_pixels(const std::vector<PixelPlace>& places, int width, int height, std::size_t group);

/// Stands in ComparedPixels::values for a pixel that does not count.
inline constexpr float kNotCompared = 1e30f;

/// Ultrasound images for lc2_parts.comp.
struct ComparedPixels {
  PixelTable table;               ///< pixels inside the fan that count in at least one image
  TexelBuffer values;             ///< R32F: per image and entry of the table, the pixel's value, or kNotCompared
  std::vector<double> variation;  ///< per image: sum of (u - mean u)^2 over the pixels that count
};

/// Returns ultrasound images for the comparison. A pixel counts inside the fan where its value is not NaN. Each image's
/// values are scaled to mean 0 and variance 1: LC2 does not depend on gain and offset, but single precision would. A
/// flat image has 0 everywhere. With up to kMaxPatches patches, and groups of up to 128, the sums of all columns fit a
/// texture.
/// @param images  at least one, all of one size
/// @param patch   side in pixels of the squares that are each compared by itself, one column each; 0: the whole picture
ComparedPixels compared_pixels(const std::vector<PixelPlace>& places, std::span<const Image<float>> images, int patch,
                               std::size_t group);

}  // namespace insonate::gl
