#pragma once

#include "devices/transport/attached_device.h"

namespace insonate {

/// Every HID device that is plugged in, once each interface.
AttachedDevices hid_devices();

}  // namespace insonate
