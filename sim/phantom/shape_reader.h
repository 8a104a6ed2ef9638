#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/phantom/recipe.h"
#include "sim/phantom/septa.h"
#include "sim/phantom/shapes.h"

namespace insonate {

/// No coordinate in a patient is larger.
inline constexpr double kFarthest_mm = 2000;

/// Converts a recipe's `shapes` tables into shapes, in their order. A shape can refer to those before it.
class ShapeReader {
public:
  ShapeReader(std::uint32_t seed, std::map<std::string, Frame> frames) : seed_(seed), frames_(std::move(frames)) {}

  /// Reads every key except `label` and `septa`, and returns the shape. A shape whose `when` is off is empty; later
  /// shapes can still refer to it. Throws InputError.
  ShapePtr read(const TomlTable& table);

  /// Reads the `septa` of a shape that was read; nothing if it has none. Throws InputError.
  std::shared_ptr<const Septa> read_septa(const TomlTable& shape) const;

private:
  ShapePtr solid(const TomlTable& table, const std::string& name);
  ShapePtr tube(const TomlTable& table, const std::string& name);
  ShapePtr rib(const TomlTable& table);
  ShapePtr loft(const TomlTable& table, const std::string& name);
  ShapePtr tree(const TomlTable& table, const std::string& name);
  ShapePtr companion(const TomlTable& table, const std::string& name);
  ShapePtr spokes_of(const TomlTable& table, const std::string& name);
  TubeForm tube_form(const TomlTable& table);
  ShapePtr part(const TomlTable& table, const std::string& key) const;
  std::vector<ShapePtr> parts(const TomlTable& table, const std::string& key) const;
  ShapePtr known(const TomlTable& table, const std::string& key, const std::string& name) const;
  const std::vector<Strand>& strands(const TomlTable& table, const std::string& key, const std::string& name) const;
  std::uint32_t seed_of(const std::string& name) const;

  std::uint32_t seed_;
  std::map<std::string, Frame> frames_;
  std::map<std::string, ShapePtr> shapes_;
  std::map<std::string, LoftForm> lofts_;
  std::map<std::string, std::vector<Strand>> strands_;  // of tubes, trees and companions
};

/// Returns the frame that a table's `frame` key names; the patient's own if there is no such key. Throws InputError for
/// an unknown name.
Frame frame_of(const TomlTable& table, const std::map<std::string, Frame>& frames);

}  // namespace insonate
