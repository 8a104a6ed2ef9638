#pragma once

#include <cstdint>

#include "sim/core/pose_sample.h"

namespace insonate {

/// Whether a sample says which buttons are held. A tracker that does not see its probe does not see them let go either;
/// in a log of PLUS, whose status words tell of switches, there is no room then for the switch.
inline bool tells_of_buttons(const PoseSample& sample) {
  return sample.status == PoseStatus::ok || sample.status == PoseStatus::switched ||
         sample.status == PoseStatus::invalid;
}

/// Finds the moments at which buttons are pressed, each once however long it is held.
///
/// A button that is held while tracking is lost and found again was pressed once.
class ButtonPresses {
public:
  /// @param held  before the first sample; unless told, what is held then was pressed for somebody else
  explicit ButtonPresses(std::uint32_t held = ~std::uint32_t(0)) : held_(held) {}

  /// To be shown every sample, in order; the bits of the buttons that it presses.
  std::uint32_t see(const PoseSample& sample) {
    const std::uint32_t pressed = sample.buttons & ~held_;
    held_ = tells_of_buttons(sample) ? sample.buttons : held_ | sample.buttons;
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
