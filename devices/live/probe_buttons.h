#pragma once

#include <cstdint>

namespace insonate {

/// Function of a button on the probe, as a bit of PoseSample::buttons, for every tracker.
enum ProbeButton : std::uint32_t {
  kFreezeButton = 1,  ///< freezes and unfreezes the picture
  kMarkButton = 2,    ///< sets an event marker at what the picture shows
  kGoOnButton = 4,    ///< continues with the next step
};

enum class ButtonsOf { hydra, polhemus, spacemouse };

/// Converts a device's own button bits to probe buttons. Buttons without a function are dropped.
std::uint32_t probe_buttons(ButtonsOf device, std::uint32_t device_bits);

}  // namespace insonate
