#pragma once

#include "devices/transport/attached_device.h"

namespace insonate {

/// Every USB device that is plugged in.
AttachedDevices usb_devices();

}  // namespace insonate
