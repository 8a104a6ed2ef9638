#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace insonate {

/// A device that is plugged in, as its bus tells of it; nothing is opened to find out.
struct AttachedDevice {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;           ///< as the device calls itself; empty where only opening it would tell
  std::string serial;         ///< likewise
  std::string path;           ///< where the system has it: "/dev/hidraw2", "bus 1, address 4"
  int interface_number = -1;  ///< of a HID device's USB interface; -1 where there is none
};

/// The devices of one bus. Where the bus cannot be asked, `problem` says why and there are none.
struct AttachedDevices {
  std::vector<AttachedDevice> devices;
  std::string problem;
};

}  // namespace insonate
