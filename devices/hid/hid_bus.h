#pragma once

#include "devices/transport/transport.h"

namespace insonate {

/// All HID devices that are plugged in, through hidapi and the kernel's hidraw, with one entry per interface.
class HidBus : public DeviceBus {
public:
  AttachedDevices devices() override;
  std::unique_ptr<Transport> open(const AttachedDevice& device, Endpoints endpoints = {}) override;
};

}  // namespace insonate
