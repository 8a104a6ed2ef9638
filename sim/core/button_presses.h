#pragma once

#include <cstdint>

#include "sim/core/pose_sample.h"

namespace insonate {

/// Finds the moments at which buttons are pressed, each once however long it is held.
///
/// A tracker that says nothing (`missing`) does not say that a button was let go, so a button that is held while
/// tracking is lost and found again was pressed once.
class ButtonPresses {
public:
  /// @param held  before the first sample; unless told, what is held then was pressed for somebody else
  explicit ButtonPresses(std::uint32_t held = ~std::uint32_t(0)) : held_(held) {}

  /// To be shown every sample, in order; the bits of the buttons that it presses.
  std::uint32_t see(const PoseSample& sample) {
    if (sample.status == PoseStatus::missing) return 0;
    const std::uint32_t pressed = sample.buttons & ~held_;
    held_ = sample.buttons;
    return pressed;
  }

  /// The sample with those buttons alone that it presses.
  PoseSample only_pressed(PoseSample sample) {
    sample.buttons = see(sample);
    return sample;
  }

private:
  std::uint32_t held_;
};

}  // namespace insonate
