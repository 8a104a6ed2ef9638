#include <algorithm>
#include <cmath>

#include "sim/core/hash.h"
#include "sim/phantom/shape_reader.h"
#include "sim/phantom/tree.h"

// The shapes and textures of a recipe that follow lines: trees, companions, spokes and septa.

namespace insonate {
const std::vector<Strand>& ShapeReader::strands(const TomlTable& table, const std::string& key,
                                                const std::string& name) const {
  const auto found = strands_.find(name);
  if (found == strands_.end())
    table.fail(key, "there is no tube, tree or companion '" + name + "' above this shape",
               suggest_from(name, strands_));
  return found->second;
}

ShapePtr ShapeReader::tree(const TomlTable& table, const std::string& name) {
  TreeRule rule;
  for (const std::string& stem : table.texts("stems", 1))
    for (const Strand& strand : strands(table, "stems", stem)) rule.stems.push_back(strand);
  if (rule.stems.empty()) table.fail("stems", "no stem has a line", "name a tube");
  rule.within = part(table, "within");
  const Bounds& bounds = rule.within->bounds();
  if (bounds.high.x >= kEverywhere.high.x || bounds.high.y >= kEverywhere.high.y || bounds.high.z >= kEverywhere.high.z)
    table.fail("within", "the shape that 'within' names has no end", "name one that half spaces do not make endless");
  rule.clear_of = parts(table, "avoid");
  rule.gap_mm = float(table.number("avoid_mm", {0, 50}, 1));
  rule.tips = int(table.whole_number("tips", 1, 500));
  rule.tip_radius_mm = float(table.number("tip_mm", {0.2, 50}));
  rule.seed = seed_of(name);
  strands_[name] = bounds.empty() ? rule.stems : grow_tree(rule);
  return make_tubes(strands_[name]);
}

ShapePtr ShapeReader::companion(const TomlTable& table, const std::string& name) {
  CompanionRule rule;
  rule.share = float(table.number("share", {0.05, 2}));
  rule.least_radius_mm = float(table.number("least_mm", {0.2, 50}));
  rule.most_radius_mm = float(table.number("most_mm", {0.2, 50}, 50));
  rule.gap_mm = float(table.number("beside_mm", {0, 50}, 0.5));
  rule.towards = table.vector("towards", {-kFarthest_mm, kFarthest_mm});
  strands_[name] = companions(strands(table, "of", table.text("of")), rule);
  return make_tubes(strands_[name]);
}

ShapePtr ShapeReader::spokes_of(const TomlTable& table, const std::string& name) {
  SpokesForm form;
  form.centre = table.vector("centre", {-kFarthest_mm, kFarthest_mm});
  form.inner = table.vector("inner", {0, kFarthest_mm});
  form.outer = table.vector("outer", {0, kFarthest_mm});
  form.count = int(table.whole_number("count", 1, 200));
  form.inner_mm = float(table.number("inner_mm", {0.2, 500}));
  form.outer_mm = float(table.number("outer_mm", {0.2, 500}));
  form.vary = float(table.number("vary", {0, 0.8}, 0));
  form.opening_deg = float(table.number("opening_deg", {0, 150}, 0));
  if (form.opening_deg > 0) form.opening = table.vector("opening", {-1, 1});
  form.seed = hash(seed_, std::uint32_t(table.whole_number("pattern", 0, 1000000, 0)));
  TubeForm straight;
  straight.smooth = false;
  strands_[name] = spokes(form);
  const auto apart = float(table.number("apart_mm", {0, 100}, 0));
  if (apart == 0) return make_tubes(strands_[name], straight);
  std::vector<ShapePtr> tubes;
  for (const Strand& spoke : strands_[name]) tubes.push_back(make_tube(spoke, straight));
  return make_apart(std::move(tubes), apart);
}

std::shared_ptr<const Septa> ShapeReader::read_septa(const TomlTable& shape) const {
  if (!shape.has("septa")) return nullptr;
  const TomlTable table = shape.table("septa");
  table.rename(shape.name() + ", its septa");
  SeptaForm form;
  form.hu = float(table.number("hu", {-1000, 1000}));
  form.apart_mm = float(table.number("apart_mm", {1, 100}));
  form.along_mm = float(table.number("along_mm", {form.apart_mm, 1000}));
  form.thick_mm = float(table.number("thick_mm", {0.2, 0.5 * form.apart_mm}, std::min(1.0, 0.5 * form.apart_mm)));
  form.mirrored = shape.boolean("mirrored", false);
  if (table.has("layers_of")) {
    form.layers_of = part(table, "layers_of");
  } else {
    const std::string line = table.text("along");
    const std::vector<Strand>& found = strands(table, "along", line);
    if (found.size() != 1) table.fail("along", "'" + line + "' is not one line", "name a tube");
    form.along = found.front();
  }
  form.seed = hash(seed_of(shape.text("name")), 1);
  return std::make_shared<Septa>(form);
}

}  // namespace insonate
