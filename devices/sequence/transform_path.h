#pragma once

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/sequence/sequence.h"

namespace insonate {

/// The coordinate frames of a transform's name, split as IGSIO does: at the first "To" before a capital letter.
struct FramePair {
  std::string_view from, to;  ///< "Probe" and "Tracker" of "ProbeToTracker"; both empty for other names
};
FramePair frames_of(std::string_view transform_name);

/// One transform of a path, taken forwards or backwards.
struct TransformLink {
  std::string name;                      ///< as the sequence has it: "ReferenceToTracker"
  int index = -1;                        ///< into Sequence::transform_names; -1 for a transform of the header
  const glm::dmat4* constant = nullptr;  ///< of the header
  bool inverse = false;                  ///< taken backwards, from Tracker to Reference
};

/// Transforms to apply one after the other, the first one first.
using TransformPath = std::vector<TransformLink>;

/// Which transforms a path may use. Those whose status is unknown in every frame are usually not a tool's.
enum class PathLinks { with_a_status, all };

/// The shortest path from one coordinate frame to another through the transforms of the frames and the header, each
/// forwards or backwards. Among paths of equal length the one whose links come earlier in the file wins, forwards
/// before backwards. Empty when there is none, and when both frames are the same.
std::optional<TransformPath> find_path(const Sequence& sequence, std::string_view from, std::string_view to,
                                       PathLinks links);

/// Whether a path depends on the frame: the transforms of the header are the same for all.
bool moves(const TransformPath& path);

/// The path for a message and for the name of what was taken: "ProbeToTracker, TrackerToReference".
std::string to_string(const TransformPath& path);

/// The matrix of a link in a frame, mm. Sets `status`; what is returned with another status than ok means nothing.
glm::dmat4 matrix_in(const Sequence& sequence, std::size_t frame, const TransformLink& link, PoseStatus& status);

/// The same of a whole path, with the status of its first link that is not ok.
glm::dmat4 matrix_in(const Sequence& sequence, std::size_t frame, const TransformPath& path, PoseStatus& status);

}  // namespace insonate
