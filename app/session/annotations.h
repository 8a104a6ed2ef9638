#pragma once

#include <map>
#include <optional>
#include <string>

#include "scenarios/action.h"
#include "sim/core/pose.h"

namespace insonate {

/// Something placed in a frozen picture, and which one: calipers of one step may lie in several.
struct Annotation {
  Action action;            ///< a caliper, ellipse, point or label
  Pose patient_from_probe;  ///< of the picture
};

/// What the actions since some moment have placed and not taken back, as a step that judges them sees it.
class Annotations {
public:
  /// Other kinds of actions change nothing.
  void apply(const Action& action, const std::optional<Pose>& frozen_picture);
  void clear();

  const std::map<int, Annotation>& measured() const { return measured_; }  ///< calipers and ellipses, by slot
  const std::optional<Annotation>& point() const { return point_; }
  const std::map<std::string, Annotation>& labels() const { return labels_; }
  /// What an action put where this one puts something, or takes it back from; nullptr for nothing.
  const Annotation* at_place_of(const Action& action) const;
  bool any() const { return !measured_.empty() || point_ || !labels_.empty(); }

private:
  std::map<int, Annotation> measured_;
  std::optional<Annotation> point_;
  std::map<std::string, Annotation> labels_;
};

/// What takes back what an action places; of a taking back itself.
Action take_back(const Action& placed);

}  // namespace insonate
