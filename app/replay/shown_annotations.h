#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/picture_tools.h"
#include "app/session/session.h"

namespace insonate {

/// The annotations and values that the screen shows over a picture. It is a self-contained value, so that a finished
/// run can store it too.
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
  std::vector<Placed> placed;               ///< in the displayed picture
  std::optional<glm::dvec2> unnamed_place;  ///< clicked in the picture and not named yet
  std::vector<Value> values;                ///< all measured values, by slot; the combined value is last
  bool operator==(const ShownAnnotations&) const = default;
};

/// @param tools  must have seen the session's current state
ShownAnnotations shown_annotations(const Session& session, const PictureTools& tools);

}  // namespace insonate
