#include "devices/found_trackers.h"

#include "devices/hid/hid_bus.h"
#include "devices/usb/usb_bus.h"

namespace insonate {
namespace {

FoundTracker find_tracker(const TrackerKind& kind, DeviceBus& bus, const AttachedDevices& attached) {
  FoundTracker found{&kind, std::string(kind.device->name), FoundTracker::State::absent, ""};
  for (const AttachedDevice& device : attached.devices)
    if (const DeviceKind::Model* model = kind.device->find(device.vendor, device.product)) {
      found.name = model->name;
      found.state = FoundTracker::State::hindered;
      break;
    }
  try {
    const AttachedDevice device = find_device(*kind.device, "", attached);
    const DeviceKind::Model* model = kind.device->find(device.vendor, device.product);
    found.name = model->name;
    bus.open(device, model->endpoints);
    found.state = FoundTracker::State::ready;
  } catch (const TransportError& error) {
    found.why = error.what();
  }
  return found;
}

}  // namespace

std::vector<FoundTracker> find_trackers(DeviceBus& hid, DeviceBus& usb) {
  const AttachedDevices on_hid = hid.devices(), on_usb = usb.devices();
  std::vector<FoundTracker> found;
  for (const TrackerKind& kind : tracker_kinds()) {
    if (!kind.device) continue;
    const bool is_hid = kind.device->bus == Bus::hid;
    found.push_back(find_tracker(kind, is_hid ? hid : usb, is_hid ? on_hid : on_usb));
  }
  return found;
}

std::vector<FoundTracker> find_trackers() {
  HidBus hid;
  UsbBus usb;
  return find_trackers(hid, usb);
}

}  // namespace insonate
