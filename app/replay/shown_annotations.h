#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/picture_tools.h"
#include "app/session/session.h"

namespace insonate {

/// What the screen shows over a picture of what is placed, and of its values: a value of its own, which a run that is
/// over keeps too.
struct ShownAnnotations {
  struct Placed {
    Action action;
    bool in_hand = false;  ///< not placed yet, or being moved
    bool operator==(const Placed&) const = default;
  };
  struct Value {
    enum class Of { picture, other_picture, in_hand };
    std::string name, text;
    Of of = Of::picture;
    bool operator==(const Value&) const = default;
  };
  std::vector<Placed> placed;               ///< in the picture that is shown
  std::optional<glm::dvec2> unnamed_place;  ///< clicked in it, without a name yet
  std::vector<Value> values;                ///< of all that is measured, by slot; what they come to is last
  bool operator==(const ShownAnnotations&) const = default;
};

/// @param tools  that have seen the session as it is
ShownAnnotations shown_annotations(const Session& session, const PictureTools& tools);

}  // namespace insonate
