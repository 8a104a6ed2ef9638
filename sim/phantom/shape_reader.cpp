#include "sim/phantom/shape_reader.h"

#include <glm/geometric.hpp>

#include <algorithm>

#include "sim/core/hash.h"

namespace insonate {
namespace {

constexpr double kThin_mm = 0.2;  // anything thinner is invisible at any voxel size

}  // namespace

Frame frame_of(const TomlTable& table, const std::map<std::string, Frame>& frames) {
  if (!table.has("frame")) return {};
  const std::string name = table.text("frame");
  const auto found = frames.find(name);
  if (found == frames.end()) table.fail("frame", "there is no frame '" + name + "'", suggest_from(name, frames));
  return found->second;
}

ShapePtr ShapeReader::known(const TomlTable& table, const std::string& key, const std::string& name) const {
  const auto found = shapes_.find(name);
  if (found == shapes_.end())
    table.fail(key, "there is no shape '" + name + "' above this one", suggest_from(name, shapes_));
  return found->second;
}

ShapePtr ShapeReader::part(const TomlTable& table, const std::string& key) const {
  return known(table, key, table.text(key));
}

std::vector<ShapePtr> ShapeReader::parts(const TomlTable& table, const std::string& key) const {
  std::vector<ShapePtr> shapes;
  for (const std::string& name : table.texts(key)) shapes.push_back(known(table, key, name));
  return shapes;
}

// The seed depends on the shape's name, not on its place: a new shape changes no other.
std::uint32_t ShapeReader::seed_of(const std::string& name) const {
  std::uint32_t seed = seed_;
  for (const char c : name) seed = hash(seed, std::uint32_t(static_cast<unsigned char>(c)));
  return seed;
}

ShapePtr ShapeReader::read(const TomlTable& table) {
  const std::string name = read_name(table);
  if (shapes_.count(name) != 0) table.fail("name", "there is another shape '" + name + "' above", "rename one");
  ShapePtr shape = solid(table, name);
  if (table.has("frame")) shape = make_placed(shape, frame_of(table, frames_));
  if (table.has("uneven_mm")) {
    const auto amplitude = float(table.number("uneven_mm", {0, 10}));
    const auto grain = float(table.number("uneven_grain_mm", {2, 500}, 30));
    if (amplitude > 0) shape = make_uneven(shape, amplitude, grain, seed_of(name));
  }
  if (table.boolean("mirrored", false)) {
    Frame mirror;
    mirror.flipped = true;
    shape = make_union({shape, make_placed(shape, mirror)}, 0);
  }
  const auto blend = float(table.number("edge_mm", {0, kRange_mm}, 0));
  if (std::vector<ShapePtr> around = parts(table, "inside"); !around.empty()) {
    const auto inset = float(table.number("inset_mm", {-20, 20}, 0));
    for (ShapePtr& one : around)
      if (inset != 0) one = make_offset(one, -inset);
    around.insert(around.begin(), shape);
    shape = make_intersection(around, blend);
  }
  if (std::vector<ShapePtr> cuts = parts(table, "clear_of"); !cuts.empty())
    shape = make_difference(shape, cuts, float(table.number("gap_mm", {-20, 20}, 0)), blend);
  if (table.has("when")) {
    table.text("when");  // a plain number is a mistake
    if (!(table.number("when") > 0)) shape = make_empty();
  }
  return shapes_[name] = shape;
}

ShapePtr ShapeReader::solid(const TomlTable& table, const std::string& name) {
  const std::string kind = table.text("kind");
  const auto blend = [&] { return float(table.number("blend_mm", {0, kRange_mm}, 0)); };
  const auto several = [&](const std::string& key) {
    std::vector<ShapePtr> shapes = parts(table, key);
    if (shapes.empty()) table.fail(key, "'" + key + "' names no shape", "name at least one");
    return shapes;
  };
  if (kind == "ellipsoid")
    return make_ellipsoid(table.vector("centre", {-kFarthest_mm, kFarthest_mm}),
                          table.vector("radii", {kThin_mm, kFarthest_mm}));
  if (kind == "box") {
    const glm::dvec3 half = table.vector("half_sizes", {kThin_mm, kFarthest_mm});
    const double rounding = table.number("rounding_mm", {0, std::min({half.x, half.y, half.z})}, 0);
    return make_box(table.vector("centre", {-kFarthest_mm, kFarthest_mm}), half, float(rounding));
  }
  if (kind == "half_space") {
    const glm::dvec3 normal = table.vector("normal", {-kFarthest_mm, kFarthest_mm});
    if (glm::length(normal) < 1e-6) table.fail("normal", "'normal' has no length", "give it a direction");
    return make_half_space(table.vector("point", {-kFarthest_mm, kFarthest_mm}), normal);
  }
  if (kind == "tube") return tube(table, name);
  if (kind == "tree") return tree(table, name);
  if (kind == "companion") return companion(table, name);
  if (kind == "spokes") return spokes_of(table, name);
  if (kind == "rib") return rib(table);
  if (kind == "loft") return loft(table, name);
  if (kind == "union") return make_union(several("of"), blend());
  if (kind == "intersection") return make_intersection(several("of"), blend());
  if (kind == "difference") return make_difference(part(table, "of"), several("minus"), 0, blend());
  if (kind == "offset") return make_offset(part(table, "of"), float(table.number("by_mm", {-30, 30})));
  if (kind == "shell") {
    const double inner = table.number("inner_mm", {-30, 30});
    return make_shell(part(table, "of"), float(inner), float(table.number("outer_mm", {inner + kThin_mm, 30})));
  }
  if (kind == "copy") {
    Frame shift;
    shift.origin = table.vector("shift", {-kFarthest_mm, kFarthest_mm}, glm::dvec3(0.0));
    return make_placed(part(table, "of"), shift);
  }
  table.fail("kind", "there is no kind '" + kind + "'",
             suggest(kind, {"ellipsoid", "box", "half_space", "tube", "rib", "loft", "tree", "companion", "spokes",
                            "union", "intersection", "difference", "offset", "shell", "copy"}));
}

TubeForm ShapeReader::tube_form(const TomlTable& table) {
  TubeForm form;
  form.smooth = table.boolean("smooth", true);
  form.bead_mm = float(table.number("bead_mm", {0, 200}, 0));
  form.bead_depth = float(table.number("bead_depth", {0, 0.5}, form.bead_mm > 0 ? 0.25 : 0));
  form.flatness = float(table.number("flatness", {0.1, 1}, 1));
  return form;
}

ShapePtr ShapeReader::tube(const TomlTable& table, const std::string& name) {
  TubeForm form = tube_form(table);
  const double radius = table.number("radius_mm", {kThin_mm, 500}, 0);
  std::vector<TubePoint> points;
  bool is_flat = form.flatness < 1;
  for (const std::vector<double>& row : table.rows("points", 2, radius > 0 ? 3 : 4, 5, {-kFarthest_mm, kFarthest_mm})) {
    const double own = row.size() > 3 ? row[3] : radius, flatness = row.size() > 4 ? row[4] : 1;
    if (own < kThin_mm || own > 500)
      table.fail("points", "a point's radius is " + std::to_string(own) + " mm", "give it 0.2 to 500 mm");
    if (flatness < 0.1 || flatness > 1)
      table.fail("points", "a point's flatness is " + std::to_string(flatness), "give it 0.1 to 1");
    is_flat = is_flat || flatness < 1;
    points.push_back({glm::vec3(row[0], row[1], row[2]), float(own), float(flatness)});
  }
  if (is_flat) form.flat_towards = table.vector("flat_towards", {-kFarthest_mm, kFarthest_mm});
  strands_[name] = {centre_line(points, form)};
  return make_tubes(strands_[name], form);
}

ShapePtr ShapeReader::rib(const TomlTable& table) {
  const std::string on = table.text("on");
  const auto found = lofts_.find(on);
  if (found == lofts_.end())
    table.fail("on", "there is no loft '" + on + "' above this shape", suggest_from(on, lofts_));
  const LoftForm& wall = found->second;
  const auto radius = float(table.number("radius_mm", {kThin_mm, 50}));
  const auto inset = float(table.number("inset_mm", {-50, 200}, 0));
  std::vector<TubePoint> points;
  float z_sum = 0;
  for (const std::vector<double>& row : table.rows("stations", 2, 2, 3, {-kFarthest_mm, kFarthest_mm})) {
    const float own_inset = row.size() == 3 ? inset + float(row[2]) : inset;
    points.push_back({wall.outline_point(float(row[0]), float(row[1]), own_inset), radius});
    z_sum += float(row[1]);
  }
  TubeForm form = tube_form(table);
  const LoftSection middle = wall.section_at(z_sum / float(points.size()));
  form.flat_towards = {middle.x, middle.y, middle.z};
  return make_tube(points, form);
}

ShapePtr ShapeReader::loft(const TomlTable& table, const std::string& name) {
  LoftForm form;
  form.squareness = float(table.number("squareness", {1.5, 8}, 2));
  for (const std::vector<double>& row : table.rows("sections", 2, 6, 6, {-kFarthest_mm, kFarthest_mm})) {
    if (row[3] < kThin_mm || row[4] < kThin_mm || row[5] < kThin_mm)
      table.fail("sections", "a section's half width, front or back is below 0.2 mm", "make it wider");
    if (!form.sections.empty() && row[0] <= form.sections.back().z)
      table.fail("sections", "the sections' z does not rise", "order them from the feet to the head");
    form.sections.push_back({float(row[0]), float(row[1]), float(row[2]), float(row[3]), float(row[4]), float(row[5])});
  }
  lofts_[name] = form;
  return make_loft(form);
}

}  // namespace insonate
