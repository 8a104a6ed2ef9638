#include "devices/found_trackers.h"

#include "scripted_bus.h"
#include <catch2/catch.hpp>

#include <string>

using namespace insonate;
using State = FoundTracker::State;

namespace {

FoundTracker found(ScriptedBus& hid, ScriptedBus& usb, const std::string& scheme) {
  for (const FoundTracker& tracker : find_trackers(hid, usb))
    if (tracker.kind->scheme == scheme) return tracker;
  FAIL("no tracker " << scheme);
  return {};
}

}  // namespace

TEST_CASE("each kind of tracker is found ready, hindered or absent, with the reason") {
  const AttachedDevice hydra{0x1532, 0x0300, "Razer Hydra", "A1", "/dev/hidraw3", 0};
  const AttachedDevice without_firmware{0x0f44, 0xef11, "", "", "bus 1, address 5", -1};
  ScriptedBus hid, usb;
  CHECK(found(hid, usb, "hydra").state == State::absent);
  CHECK(found(hid, usb, "hydra").why == "The Razer Hydra is not plugged in.");

  hid.attached.devices = {hydra};
  usb.attached.devices = {without_firmware};
  const FoundTracker ready = found(hid, usb, "hydra");
  CHECK(ready.state == State::ready);
  CHECK(ready.why.empty());
  CHECK(ready.uri() == "hydra:");
  CHECK(hid.opened == hydra.path);
  CHECK(hid.open_now == 0);
  CHECK(usb.open_now == 0);

  hid.refuses = forbidden(hydra);
  CHECK(found(hid, usb, "hydra").state == State::hindered);
  CHECK(found(hid, usb, "hydra").why.find("may not be opened by this user") != std::string::npos);

  INFO("what waits for its firmware is plugged in, and cannot be used");
  CHECK(found(hid, usb, "polhemus").state == State::hindered);
  CHECK(found(hid, usb, "polhemus").why.find("waits for its firmware") != std::string::npos);
}
