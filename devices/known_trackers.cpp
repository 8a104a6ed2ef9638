#include "devices/known_trackers.h"

namespace insonate {
namespace {

constexpr std::string_view kWaits = "waits for its firmware: load it with the maker's software, then plug in again";

// Numbers from the devices' public drivers and their makers' manuals. More specific entries come first.
constexpr KnownTracker kKnown[] = {
    {Bus::hid, 0x1532, 0x0300, "Razer Hydra", ""},
    {Bus::hid, 0x1532, 0x0b00, "OSVR HDK head tracker", "tells orientation only"},
    {Bus::hid, 0x03eb, 0x2421, "OSVR HDK head tracker", "tells orientation only"},
    {Bus::hid, 0x046d, 0xc626, "3Dconnexion SpaceNavigator", "moves the probe at a desk"},
    {Bus::hid, 0x256f, 0xc635, "3Dconnexion SpaceMouse Compact", "moves the probe at a desk"},
    {Bus::hid, 0x256f, 0xc62e, "3Dconnexion SpaceMouse Wireless", "moves the probe at a desk"},
    {Bus::hid, 0x256f, kAnyProduct, "3Dconnexion SpaceMouse", "moves the probe at a desk"},
    {Bus::usb, 0x0f44, 0xef12, "Polhemus Patriot", ""},
    {Bus::usb, 0x0f44, 0xef20, "Polhemus Patriot HS", ""},
    {Bus::usb, 0x0f44, 0xff20, "Polhemus Liberty HS", ""},
    {Bus::usb, 0x0f44, 0xbf01, "Polhemus Viper", ""},
    {Bus::usb, 0x0f44, 0xef11, "Polhemus tracker", kWaits},
    {Bus::usb, 0x0f44, 0xef21, "Polhemus tracker", kWaits},
    {Bus::usb, 0x0f44, 0xff11, "Polhemus tracker", kWaits},
    {Bus::usb, 0x0f44, 0xff21, "Polhemus tracker", kWaits},
    {Bus::usb, 0x0f44, 0x0001, "Polhemus tracker", kWaits},
};

}  // namespace

const KnownTracker* known_tracker(Bus bus, std::uint16_t vendor, std::uint16_t product) {
  for (const KnownTracker& known : kKnown)
    if (known.bus == bus && known.vendor == vendor && (known.product == product || known.product == kAnyProduct))
      return &known;
  return nullptr;
}

}  // namespace insonate
