#pragma once

#include <optional>

#include "devices/report.h"

namespace insonate {

/// A 3Dconnexion SpaceMouse's input report: what one report tells of, the rest is empty. Wired ones send translation
/// and rotation in turn, wireless ones both at once. +x is to the right, +y towards the user, +z down.
struct SpaceMouseReport {
  std::optional<glm::dvec3> push;        ///< each axis from -1 to 1, the cap's full travel
  std::optional<glm::dvec3> turn;        ///< likewise, about the same axes
  std::optional<std::uint32_t> buttons;  ///< bit b is set while button b is held
};

/// A report of another number (battery, lights) has the fault `header`.
Parsed<SpaceMouseReport> parse_spacemouse(Bytes bytes);

}  // namespace insonate
