#pragma once

#include "devices/transport/transport.h"

namespace insonate {

/// All USB devices that are plugged in, through libusb. open() uses a device's first interface and two bulk endpoints.
class UsbBus : public DeviceBus {
public:
  AttachedDevices devices() override;
  std::unique_ptr<Transport> open(const AttachedDevice& device, Endpoints endpoints) override;
};

}  // namespace insonate
