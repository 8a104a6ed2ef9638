#pragma once

#include <string>
#include <vector>

#include "devices/registry.h"
#include "devices/transport/transport.h"

namespace insonate {

/// A kind of tracker on a bus, and whether it can be used now.
struct FoundTracker {
  enum class State {
    ready,     ///< plugged in, and this user may open it
    hindered,  ///< plugged in, but it cannot be used as it is
    absent     ///< not plugged in
  };
  const TrackerKind* kind = nullptr;  ///< never null
  std::string name;                   ///< of the model, or of the kind if it is absent: "Razer Hydra"
  State state = State::absent;
  std::string why;  ///< a sentence on why it cannot be used and what to do; empty if it is ready

  std::string uri() const { return std::string(kind->scheme) + ":"; }
};

/// Returns every kind of tracker on HID and USB, in the order of the registry. Opens each device that is plugged in and
/// closes it at once, because only that shows whether it can be used. So call it while no tracker is open: a device
/// that this program uses itself would be reported as busy.
std::vector<FoundTracker> find_trackers(DeviceBus& hid, DeviceBus& usb);

/// Does so on this computer's buses.
std::vector<FoundTracker> find_trackers();

}  // namespace insonate
