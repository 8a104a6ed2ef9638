#include "sim/phantom/plan.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "sim/phantom/shape_reader.h"

namespace insonate {
namespace {

constexpr double kFar_mm = 2000;
constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
constexpr double kMaxVoxelsPerSide = 2048;
constexpr std::size_t kMaxVoxels = std::size_t(1) << 29;  // 1.6 GB with their labels

Grid read_grid(const TomlTable& table) {
  const glm::dvec3 from = table.vector("from", {-kFar_mm, kFar_mm});
  const glm::dvec3 to = table.vector("to", {-kFar_mm, kFar_mm});
  Grid grid;
  const double pitch = table.number("voxel_mm", {0.2, 50});
  grid.spacing = glm::dvec3(pitch);
  for (int axis = 0; axis < 3; ++axis) {
    const double voxels = std::floor((to[axis] - from[axis]) / pitch);
    if (voxels < 2 || voxels > kMaxVoxelsPerSide)
      table.fail("to", "the grid has " + std::to_string(long(voxels)) + " voxels along axis " + std::to_string(axis),
                 "choose from, to and voxel_mm for 2 to 2048");
    grid.size[axis] = int(voxels);
  }
  if (grid.count() > kMaxVoxels)
    table.fail("voxel_mm", "the grid has " + std::to_string(grid.count()) + " voxels",
               "choose from, to and voxel_mm for at most " + std::to_string(kMaxVoxels));
  grid.origin = from + grid.spacing / 2.0;
  return grid;
}

std::vector<PaintedLabel> read_labels_key(const TomlTable& root) {
  std::vector<PaintedLabel> labels;
  std::set<std::string> names;
  for (const TomlTable& table : root.tables("labels", kAny, "label")) {
    PaintedLabel made;
    made.label.name = read_name(table);
    made.label.tissue = table.text("tissue");
    made.hu = float(table.number("hu", {-1024, 30000}));
    made.texture_hu = float(table.number("texture_hu", {0, 1000}, 0));
    made.grain_mm = float(table.number("grain_mm", {0.2, 500}, 2));
    if (!names.insert(made.label.name).second)
      table.fail("name", "there are two labels '" + made.label.name + "'", "rename one");
    if (labels.size() == 255) table.fail("name", "there are more than 255 labels", "join some");
    made.label.value = std::uint8_t(labels.size() + 1);
    labels.push_back(made);
  }
  if (labels.empty()) root.fail("labels", "there are no labels", "list at least one");
  return labels;
}

std::map<std::string, Frame> read_frames(const TomlTable& root) {
  std::map<std::string, Frame> frames;
  for (const TomlTable& table : root.tables("frames", kAny, "frame")) {
    const std::string name = read_name(table);
    Frame frame;
    frame.origin = table.vector("at", {-kFar_mm, kFar_mm});
    const glm::dvec3 turn = glm::radians(table.vector("turn_deg", {-360, 360}, glm::dvec3(0.0)));
    glm::dmat4 rotation(1.0);
    rotation = glm::rotate(rotation, turn.z, glm::dvec3(0, 0, 1));
    rotation = glm::rotate(rotation, turn.y, glm::dvec3(0, 1, 0));
    rotation = glm::rotate(rotation, turn.x, glm::dvec3(1, 0, 0));
    frame.rotation = glm::mat3(rotation);
    frame.flipped = table.boolean("flipped", false);
    if (!frames.emplace(name, frame).second) table.fail("name", "there are two frames '" + name + "'", "rename one");
  }
  return frames;
}

std::vector<PaintedShape> read_shapes(const TomlTable& root, ShapeReader& reader,
                                      const std::vector<PaintedLabel>& labels) {
  std::map<std::string, std::size_t> label_index;
  for (std::size_t n = 0; n < labels.size(); ++n) label_index[labels[n].label.name] = n;
  std::vector<PaintedShape> shapes;
  for (const TomlTable& table : root.tables("shapes", kAny, "shape")) {
    rename_after_key(table, "shape");
    const ShapePtr shape = reader.read(table);
    if (table.has("label")) {
      const std::string label = table.text("label");
      const auto found = label_index.find(label);
      if (found == label_index.end())
        table.fail("label", "there is no label '" + label + "'", suggest_from(label, label_index));
      shapes.push_back({shape, found->second, reader.read_septa(table)});
    }
    table.refuse_unknown_keys();
  }
  if (shapes.empty()) root.fail("shapes", "no shape has a label, so nothing would be drawn", "add a shape");
  return shapes;
}

std::map<std::string, glm::dvec3> read_landmarks(const TomlTable& root, const std::map<std::string, Frame>& frames,
                                                 std::vector<Landmark>& landmarks) {
  std::map<std::string, glm::dvec3> positions;
  for (const TomlTable& table : root.tables("landmarks", kAny, "landmark")) {
    Landmark landmark;
    landmark.name = read_name(table);
    const glm::dvec3 at = table.vector("at", {-kFar_mm, kFar_mm});
    landmark.position = table.has("frame") ? glm::dvec3(frame_of(table, frames).patient_from_part(at)) : at;
    if (!positions.emplace(landmark.name, landmark.position).second)
      table.fail("name", "there are two landmarks '" + landmark.name + "'", "rename one");
    landmarks.push_back(landmark);
  }
  return positions;
}

class ViewReader {
public:
  ViewReader(const std::map<std::string, glm::dvec3>& landmarks, const std::vector<PaintedLabel>& labels)
      : landmarks_(landmarks) {
    for (std::size_t n = 0; n < labels.size(); ++n) labels_[labels[n].label.name] = n;
  }

  std::vector<PlannedView> read(const TomlTable& root) {
    std::vector<PlannedView> views;
    std::set<std::string> names;
    for (const TomlTable& table : root.tables("views", kAny, "view")) {
      views.push_back(view(table));
      const std::string& name = views.back().view.name;
      if (!names.insert(name).second) table.fail("", "there are two views '" + name + "'", "rename one");
    }
    return views;
  }

private:
  PlannedView view(const TomlTable& table) {
    rename_after_key(table, "view");
    PlannedView made;
    made.view.name = read_name(table);
    made.view.title = table.text("title");
    made.view.probe = table.text("probe");
    made.view.depth_mm = table.number("depth_mm", {20, 300}, 160);
    made.view.landmarks = names(table, "landmarks", landmarks_, "landmark");
    made.view.targets = names(table, "targets", labels_, "label");
    made.aim = point(table, "aim");
    const glm::dvec3 way = made.aim - point(table, "from");
    if (glm::length(way) < 1) table.fail("from", "it looks from where it aims at", "move one of the points");
    made.beam = glm::normalize(way);
    const glm::dvec3 lateral = marker(table);
    const glm::dvec3 square = lateral - made.beam * glm::dot(lateral, made.beam);
    if (glm::length(square) < 0.1 * glm::length(lateral) || glm::length(lateral) < 1e-6)
      table.fail("marker", "the marker points along the beam", "point it across");
    made.marker = glm::normalize(square);
    made.press_mm = table.number("press_mm", {0, 30}, 8);
    return made;
  }

  template <typename Value>
  static std::vector<std::string> names(const TomlTable& table, const std::string& key,
                                        const std::map<std::string, Value>& known, const std::string& noun) {
    std::vector<std::string> found = table.texts(key);
    for (const std::string& name : found)
      if (known.count(name) == 0) table.fail(key, "there is no " + noun + " '" + name + "'", suggest_from(name, known));
    return found;
  }

  const glm::dvec3& landmark(const TomlTable& table, const std::string& key, const std::string& name) {
    const auto found = landmarks_.find(name);
    if (found == landmarks_.end())
      table.fail(key, "there is no landmark '" + name + "'", suggest_from(name, landmarks_));
    return found->second;
  }

  glm::dvec3 point(const TomlTable& table, const std::string& key) {
    if (table.kind(key) == TomlKind::text) return landmark(table, key, table.text(key));
    return table.vector(key, {-kFar_mm, kFar_mm});
  }

  // Reads three numbers, or the names of two landmarks: the direction is from the first towards the second.
  glm::dvec3 marker(const TomlTable& table) {
    if (table.list_length("marker") != 2) return table.vector("marker", {-kFar_mm, kFar_mm});
    const std::vector<std::string> ends = table.texts("marker");
    return landmark(table, "marker", ends[1]) - landmark(table, "marker", ends[0]);
  }

  const std::map<std::string, glm::dvec3>& landmarks_;
  std::map<std::string, std::size_t> labels_;
};

}  // namespace

PhantomPlan plan_phantom(const Recipe& recipe) {
  const TomlTable root = recipe.root();
  PhantomPlan plan;
  plan.name = root.text("name");
  plan.seed = std::uint32_t(root.number("seed", {0, 4294967295.0}, 1));
  plan.grid = read_grid(root.table("grid"));
  plan.labels = read_labels_key(root);
  const std::map<std::string, Frame> frames = read_frames(root);
  ShapeReader reader(plan.seed, frames);
  plan.shapes = read_shapes(root, reader, plan.labels);
  const std::map<std::string, glm::dvec3> positions = read_landmarks(root, frames, plan.landmarks);
  plan.views = ViewReader(positions, plan.labels).read(root);
  root.refuse_unknown_keys();
  return plan;
}

}  // namespace insonate
