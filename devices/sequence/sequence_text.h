#pragma once

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <string>
#include <string_view>

#include "sim/core/pose_sample.h"

// A sequence file's text piece by piece, for those that write one at once and those that write one as it grows.

namespace insonate {

/// The header's lines in front of the frames'. `size` is that of a frame's picture in pixels and of how many frames
/// there are, as "640 480 30"; "0 0 30" for transforms only.
std::string sequence_head(const std::string& size, bool compressed);

/// Appends the lines of a frame: the pose as ProbeToPatient, to the last bit, its status, buttons,
/// distortion, rejection, times.
/// Of a sample that is not ok the pose is not kept. With `probe_from_pixel` also where its picture lies, as
/// ImageToProbe; with `actions`, one line of printable characters, what was done since the frame before. IGSIO reads
/// lines of at most 1000 characters, the field's name among them.
void append_frame(std::string& text, std::size_t index, const PoseSample& sample,
                  const glm::dmat4* probe_from_pixel = nullptr, std::string_view actions = {});

/// The line behind the frames', after which the pictures' bytes follow.
inline constexpr std::string_view kSequenceEnd = "ElementDataFile = LOCAL\n";

/// No scan pauses for longer. More is a clock that was set while it ran, and would keep whoever replays it waiting.
inline constexpr double kLongestStepS = 24 * 3600;

/// Why no one could read `sample` back after one of the time `before_s`; empty when one can.
std::string why_not_recordable(const PoseSample& sample, double before_s);

}  // namespace insonate
