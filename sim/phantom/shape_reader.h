#pragma once

#include <map>
#include <string>

#include "sim/phantom/recipe.h"
#include "sim/phantom/shapes.h"

namespace insonate {

/// Converts a recipe's `shapes` tables into shapes, in their order. A shape can refer to those before it.
class ShapeReader {
public:
  ShapeReader(const Recipe& recipe, std::uint32_t seed, std::map<std::string, Frame> frames)
      : recipe_(recipe), seed_(seed), frames_(std::move(frames)) {}

  /// Reads every key except `label`, and returns the shape. A shape whose `when` is off is empty; later shapes can
  /// still refer to it. Throws InputError.
  ShapePtr read(RecipeTable& table);

private:
  ShapePtr solid(RecipeTable& table, const std::string& name);
  ShapePtr tube(RecipeTable& table);
  ShapePtr rib(RecipeTable& table);
  ShapePtr loft(RecipeTable& table, const std::string& name);
  TubeForm tube_form(RecipeTable& table);
  ShapePtr part(RecipeTable& table, const std::string& key);
  std::vector<ShapePtr> parts(RecipeTable& table, const std::string& key);
  ShapePtr known(RecipeTable& table, const std::string& key, const std::string& name);

  const Recipe& recipe_;
  std::uint32_t seed_;
  std::uint32_t read_so_far_ = 0;
  std::map<std::string, Frame> frames_;
  std::map<std::string, ShapePtr> shapes_;
  std::map<std::string, LoftForm> lofts_;
};

/// Returns the frame that a table's `frame` key names; the patient's own if there is no such key. Throws InputError for
/// an unknown name.
Frame frame_of(RecipeTable& table, const std::map<std::string, Frame>& frames);

}  // namespace insonate
