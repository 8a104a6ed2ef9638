#pragma once

#include <cstdint>

namespace insonate {

/// What a button on the probe does, as a bit of PoseSample::buttons, whatever tracker it is on.
enum ProbeButton : std::uint32_t {
  kFreezeButton = 1,  ///< freezes the picture, and thaws it
  kMarkButton = 2,    ///< marks what the picture shows
  kGoOnButton = 4,    ///< goes on to the next step
};

enum class ButtonsOf { hydra, polhemus, spacemouse };

/// A device's own button bits as probe buttons. Those without a meaning are left out.
std::uint32_t probe_buttons(ButtonsOf device, std::uint32_t device_bits);

}  // namespace insonate
