#pragma once

#include <cstdint>

#include "sim/core/probe_sample.h"

namespace insonate {

/// Returns whether a sample of this status reports which buttons are held. A tracker that has lost its probe cannot
/// report that a button was released. A PLUS log reports switches in its status words, so a sample with another status
/// has no room for them.
inline bool reports_buttons(PoseStatus status) {
  return status == PoseStatus::ok || status == PoseStatus::switched || status == PoseStatus::invalid;
}

/// Finds the moments at which buttons are pressed. Each press counts once, however long the button is held.
///
/// A button that is held while tracking is lost and found again counts as pressed once.
class ButtonPresses {
public:
  /// @param held  the buttons held before the first sample, as bits. By default all: a button that is held in the first
  /// sample was pressed before this object existed and does not count.
  explicit ButtonPresses(std::uint32_t held = ~std::uint32_t(0)) : held_(held) {}

  /// Returns the bits of the buttons that this sample presses. The caller passes every sample, in order.
  /// @tparam Sample  a ProbeSample or a SensorSample
  template <typename Sample>
  std::uint32_t see(const Sample& sample) {
    const std::uint32_t pressed = sample.buttons & ~held_;
    held_ = reports_buttons(sample.status) ? sample.buttons : held_ | sample.buttons;
    return pressed;
  }

  /// Returns the sample with only the bits of newly pressed buttons set. Counts as a call of see().
  template <typename Sample>
  Sample only_pressed(Sample sample) {
    sample.buttons = see(sample);
    return sample;
  }

private:
  std::uint32_t held_;
};

}  // namespace insonate
