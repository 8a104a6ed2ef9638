#pragma once

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <string>
#include <string_view>

#include "sim/core/probe_sample.h"

// The parts of a sequence file's text, for writers of a whole file and writers of a growing one.

namespace insonate {

/// Returns the header's lines before those of the frames. `size` gives a picture's size in pixels and the number of
/// frames, as "640 480 30", or "0 0 30" for transforms only.
std::string sequence_head(const std::string& size, bool compressed);

/// Appends the lines of a frame: the pose as ProbeToPatient, exact to the last bit, its status, buttons, distortion,
/// rejection and times. The pose of a sample that is not ok is not stored. With `probe_from_pixel` it appends the
/// picture's position as ImageToProbe. With `actions`, one line of printable characters, it appends what was done since
/// the previous frame. IGSIO reads lines of at most 1000 characters, including the field's name.
void append_frame(std::string& text, std::size_t index, const ProbeSample& sample,
                  const glm::dmat4* probe_from_pixel = nullptr, std::string_view actions = {});

/// The line after those of the frames; the pictures' bytes follow it.
inline constexpr std::string_view kSequenceEnd = "ElementDataFile = LOCAL\n";

/// No scan pauses for longer. A longer step means that a clock was set during the scan, and a replay would wait that
/// long.
inline constexpr double kLongestStep_s = 24 * 3600;

/// Returns why `sample` could not be read back after a sample with time `before_s`; empty if it could.
std::string why_not_recordable(const ProbeSample& sample, double before_s);

}  // namespace insonate
