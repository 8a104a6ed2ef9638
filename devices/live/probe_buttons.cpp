#include "devices/live/probe_buttons.h"

namespace insonate {
namespace {

struct Line {
  ButtonsOf device;
  std::uint32_t device_bit;
  ProbeButton button;
};

constexpr Line kLines[] = {
    {ButtonsOf::hydra, 0, kFreezeButton},       // bumper
    {ButtonsOf::hydra, 2, kMarkButton},         // button 1
    {ButtonsOf::hydra, 3, kGoOnButton},         // button 2
    {ButtonsOf::polhemus, 0, kFreezeButton},    // a stylus has one or two buttons
    {ButtonsOf::polhemus, 1, kMarkButton},      //
    {ButtonsOf::spacemouse, 0, kFreezeButton},  // left
    {ButtonsOf::spacemouse, 1, kMarkButton},    // right
};

}  // namespace

std::uint32_t probe_buttons(ButtonsOf device, std::uint32_t device_bits) {
  std::uint32_t buttons = 0;
  for (const Line& line : kLines)
    if (line.device == device && (device_bits >> line.device_bit & 1) != 0) buttons |= line.button;
  return buttons;
}

}  // namespace insonate
