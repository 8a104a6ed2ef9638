#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "sim/core/image.h"
#include "sim/probe/probe.h"

namespace insonate {

/// The geometry of a probe, as its images show it.
struct FoundFan {
  Probe probe;          ///< kind, and radius, field of view or width; the rest is that of the kind's built-in probe
  double depth_mm = 0;  ///< to the deepest echo along the beam
  glm::dvec2 face_pixel{0.0};  ///< column and row of the middle of the probe's face, which may lie outside the image
  std::array<int, 4> clip{};   ///< x, y, width, height of the part of the image that has echo, pixels
  double shown = 1;            ///< share of the fan that lies in that part; the image cuts the rest off
  double filled = 0;           ///< share of the fan's pixels there that carry echo
};

/// Either a fan or the reason why there is none, as the problem part of an InputError.
struct FanSearch {
  std::optional<FoundFan> fan;
  std::string problem;
};

/// Finds the fan of a probe from the pixels that carry echo (EchoSeen::mask()). The central beam runs down the image's
/// columns, so a fan that is steered to a side is not found as what it is. A fan that the image cuts off is found if
/// enough of its edges is left.
///
/// Each kind of probe is fitted by maximising the mutual information of "inside the fan" and "carries echo", which a
/// shadow inside the fan or a speck beside it hardly changes. The kind with the highest value is taken; the simpler one
/// where two are nearly equal.
/// @param mm_per_pixel  along the rows and along the columns
FanSearch find_fan(const Image<std::uint8_t>& mask, const glm::dvec2& mm_per_pixel);

/// Returns a found fan in one sentence for the user: "curvilinear, radius 60.2 mm, ...".
std::string description(const FoundFan& fan);
/// The same without the face's pixel and how much of the fan is shown.
std::string probe_description(const FoundFan& fan);

}  // namespace insonate
