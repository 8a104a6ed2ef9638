#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace insonate {

/// A device that is plugged in, as its bus reports it without opening the device.
struct AttachedDevice {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;           ///< as the device reports it; empty where only opening the device would reveal it
  std::string serial;         ///< likewise
  std::string path;           ///< where the operating system lists it: "/dev/hidraw2", "bus 1, address 4"
  int interface_number = -1;  ///< number of a HID device's USB interface; -1 if there is none
};

/// The devices of one bus. If the bus cannot be listed, `problem` states why and `devices` is empty.
struct AttachedDevices {
  std::vector<AttachedDevice> devices;
  std::string problem;
};

}  // namespace insonate
