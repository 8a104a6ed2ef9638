#pragma once

#include <cstdint>
#include <span>

namespace insonate {

/// Function of a button on the probe, as a bit of ProbeSample::buttons, for every tracker.
enum ProbeButton : std::uint32_t {
  kFreezeButton = 1,       ///< freezes and unfreezes the picture
  kEventMarkerButton = 2,  ///< sets an event marker at what the picture shows
  kContinueButton = 4,     ///< continues with the next step
};

/// A device's own button bit, and what it means.
struct ButtonMeaning {
  std::uint32_t device_bit;  ///< 0 to 31
  ProbeButton button;
};

/// Returns a device's button bits as probe buttons. Bits without a meaning are dropped.
inline std::uint32_t probe_buttons(std::span<const ButtonMeaning> meanings, std::uint32_t device_bits) {
  std::uint32_t buttons = 0;
  for (const ButtonMeaning& meaning : meanings)
    if (device_bits >> meaning.device_bit & 1) buttons |= meaning.button;
  return buttons;
}

}  // namespace insonate
