#pragma once

#include "devices/transport/transport.h"

namespace insonate {

/// Every HID device that is plugged in, once each interface, by hidapi and the kernel's hidraw.
class HidBus : public DeviceBus {
public:
  AttachedDevices devices() override;
  std::unique_ptr<Transport> open(const AttachedDevice& device, Endpoints endpoints = {}) override;
};

}  // namespace insonate
