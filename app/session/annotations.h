#pragma once

#include <map>
#include <optional>
#include <string>

#include "scenarios/action.h"
#include "sim/core/pose.h"

namespace insonate {

/// Something placed in a frozen picture, with the pose of that picture: the calipers of one step may lie in several
/// pictures.
struct Annotation {
  Action action;            ///< a caliper, ellipse, point or label
  Pose patient_from_probe;  ///< of the picture
};

/// Collects what actions have placed since the last clear() and not removed since, as a step that scores them sees it.
class Annotations {
public:
  /// Applies an action. Actions that neither place nor remove an annotation change nothing.
  void apply(const Action& action, const std::optional<Pose>& frozen_picture);
  void clear();

  const std::map<int, Annotation>& measured() const { return measured_; }  ///< calipers and ellipses, by slot
  const std::optional<Annotation>& point() const { return point_; }
  const std::map<std::string, Annotation>& labels() const { return labels_; }
  /// Returns the existing annotation that `action` would replace or remove; nullptr if there is none.
  const Annotation* at_place_of(const Action& action) const;
  bool any() const { return !measured_.empty() || point_ || !labels_.empty(); }

private:
  std::map<int, Annotation> measured_;
  std::optional<Annotation> point_;
  std::map<std::string, Annotation> labels_;
};

/// Returns the action that removes what `placed` places. For a removing action it returns that same action.
Action take_back(const Action& placed);

}  // namespace insonate
