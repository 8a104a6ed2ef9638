#pragma once

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/sequence/sequence.h"

namespace insonate {

/// The coordinate frames in a transform's name, which is split as in IGSIO: at the first "To" before a capital letter.
struct FramePair {
  std::string_view from, to;  ///< "Probe" and "Tracker" of "ProbeToTracker"; both empty for other names
};
FramePair frames_of(std::string_view transform_name);

/// One transform of a path, used forwards or backwards.
struct TransformLink {
  std::string name;                      ///< as in the sequence: "ReferenceToTracker"
  int index = -1;                        ///< into Sequence::transform_names; -1 for a transform of the header
  const glm::dmat4* constant = nullptr;  ///< matrix of a transform of the header, else null
  bool inverse = false;                  ///< used backwards, from Tracker to Reference
};

/// Transforms to apply in this order.
using TransformPath = std::vector<TransformLink>;

/// Which transforms a path may use. Transforms whose status is unknown in every frame usually do not belong to a tool.
enum class PathLinks { with_a_status, all };

/// Returns the shortest path from one coordinate frame to another through the transforms of the frames and the header,
/// each forwards or backwards. Among paths of equal length it prefers links that come earlier in the file, and forwards
/// to backwards. Empty if there is no path, or if both frames are the same.
std::optional<TransformPath> find_path(const Sequence& sequence, std::string_view from, std::string_view to,
                                       PathLinks links);

/// Returns whether a path depends on the frame. The transforms of the header are the same for all frames.
bool moves(const TransformPath& path);

/// Returns the path for messages and for the name of the transform used: "ProbeToTracker, TrackerToReference".
std::string to_string(const TransformPath& path);

/// Returns the matrix of a link in a frame, mm. Sets `status`; unless it is ok, the matrix is meaningless.
glm::dmat4 matrix_in(const Sequence& sequence, std::size_t frame, const TransformLink& link, PoseStatus& status);

/// Does the same for a whole path. The status is that of its first link that is not ok.
glm::dmat4 matrix_in(const Sequence& sequence, std::size_t frame, const TransformPath& path, PoseStatus& status);

}  // namespace insonate
