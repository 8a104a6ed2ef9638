#pragma once

#include <optional>

#include "devices/report.h"

namespace insonate {

/// An input report of a 3Dconnexion SpaceMouse. Fields that a report does not contain are empty. Wired models alternate
/// between translation and rotation; wireless models send both at once. +x is right, +y towards the user, +z down.
struct SpaceMouseReport {
  std::optional<glm::dvec3> push;        ///< each axis from -1 to 1, the cap's full travel
  std::optional<glm::dvec3> turn;        ///< likewise, about the same axes
  std::optional<std::uint32_t> buttons;  ///< bit b is set while button b is held
};

/// Parses a report. A report with another number (battery, lights) has the fault `header`.
Parsed<SpaceMouseReport> parse_spacemouse(Bytes bytes);

}  // namespace insonate
