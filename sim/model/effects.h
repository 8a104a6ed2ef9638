#pragma once

#include <span>
#include <string_view>

#include "sim/model/settings.h"

namespace insonate {

/// A part of the model that a person can turn off or change, to see what it does to the picture (docs/effects.md).
struct Effect {
  std::string_view name;  ///< in logs
  double least, most;     ///< of the value; 0 and 1 for what can only be on or off
  bool whole;             ///< the value is a whole number
  double (*value)(const Settings&);
  void (*set)(Settings&, double value);

  bool is_switch() const { return whole && least == 0 && most == 1; }
};

/// Returns all effects: switches first, then numbers.
std::span<const Effect> effects();

/// Returns the effect of a name, or null.
const Effect* find_effect(std::string_view name);

}  // namespace insonate
