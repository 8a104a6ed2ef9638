#pragma once

#include "devices/transport/transport.h"

namespace insonate {

/// Every USB device that is plugged in, by libusb; opened are its first interface and two bulk endpoints.
class UsbBus : public DeviceBus {
public:
  AttachedDevices devices() override;
  std::unique_ptr<Transport> open(const AttachedDevice& device, Endpoints endpoints) override;
};

}  // namespace insonate
