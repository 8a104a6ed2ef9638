#include "devices/sequence/transform_path.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cctype>
#include <deque>
#include <map>

namespace insonate {
namespace {

struct Edge {
  std::string_view from, to;
  TransformLink link;
};

/// Returns for each transform of the frames whether any frame has a status for it.
std::vector<bool> with_a_status(const Sequence& sequence) {
  std::vector<bool> found(sequence.transform_names.size());
  for (const SequenceFrame& frame : sequence.frames)
    for (const SequenceTransform& transform : frame.transforms)
      if (transform.status != PoseStatus::unknown) found[std::size_t(transform.name)] = true;
  return found;
}

/// Returns both directions of each transform. Those of the frames come before those of the header.
std::vector<Edge> edges_of(const Sequence& sequence, PathLinks links) {
  std::vector<Edge> edges;
  const auto add = [&](const std::string& name, int index, const glm::dmat4* constant) {
    const FramePair frames = frames_of(name);
    if (frames.from.empty()) return;
    edges.push_back({frames.from, frames.to, TransformLink{name, index, constant, false}});
    edges.push_back({frames.to, frames.from, TransformLink{name, index, constant, true}});
  };
  const std::vector<bool> stated = with_a_status(sequence);
  for (std::size_t i = 0; i < sequence.transform_names.size(); ++i)
    if (links == PathLinks::all || stated[i]) add(sequence.transform_names[i], int(i), nullptr);
  for (const auto& [name, matrix] : sequence.constants)
    if (sequence.find(name) < 0) add(name, -1, &matrix);
  return edges;
}

}  // namespace

FramePair frames_of(std::string_view name) {
  for (std::size_t to = name.find("To"); to != std::string_view::npos; to = name.find("To", to + 2))
    if (to > 0 && to + 2 < name.size() && std::isupper(static_cast<unsigned char>(name[to + 2])))
      return {name.substr(0, to), name.substr(to + 2)};
  return {};
}

std::optional<TransformPath> find_path(const Sequence& sequence, std::string_view from, std::string_view to,
                                       PathLinks links) {
  const std::vector<Edge> edges = edges_of(sequence, links);
  std::map<std::string_view, const Edge*> reached_by{{from, nullptr}};
  for (std::deque<std::string_view> open{from}; !open.empty(); open.pop_front())
    for (const Edge& edge : edges)
      if (edge.from == open.front() && reached_by.emplace(edge.to, &edge).second) open.push_back(edge.to);
  if (from == to || !reached_by.contains(to)) return std::nullopt;

  TransformPath path;
  for (const Edge* edge = reached_by.at(to); edge; edge = reached_by.at(edge->from)) path.push_back(edge->link);
  std::reverse(path.begin(), path.end());
  return path;
}

bool moves(const TransformPath& path) {
  return std::any_of(path.begin(), path.end(), [](const TransformLink& link) { return link.index >= 0; });
}

std::string to_string(const TransformPath& path) {
  std::string text;
  for (const TransformLink& link : path) {
    if (!text.empty()) text += ", ";
    const FramePair frames = frames_of(link.name);
    text += link.inverse ? std::string(frames.to) + "To" + std::string(frames.from) : link.name;
  }
  return text;
}

glm::dmat4 matrix_in(const Sequence& sequence, std::size_t frame, const TransformLink& link, PoseStatus& status) {
  const glm::dmat4* matrix = link.constant;
  status = PoseStatus::ok;
  if (!matrix) {
    const SequenceTransform* transform = sequence.frames[frame].find(link.index);
    status = transform ? transform->status : PoseStatus::missing;
    if (status != PoseStatus::ok) return glm::dmat4(0.0);
    matrix = &transform->matrix;
  }
  return link.inverse ? glm::inverse(*matrix) : *matrix;
}

glm::dmat4 matrix_in(const Sequence& sequence, std::size_t frame, const TransformPath& path, PoseStatus& status) {
  glm::dmat4 whole(1.0);
  for (const TransformLink& link : path) {
    whole = matrix_in(sequence, frame, link, status) * whole;
    if (status != PoseStatus::ok) break;
  }
  return whole;
}

}  // namespace insonate
