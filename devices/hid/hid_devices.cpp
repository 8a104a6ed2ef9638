#include "devices/hid/hid_devices.h"

#include <hidapi.h>

#include <memory>

namespace insonate {
namespace {

/// The printable ASCII of what a device says of itself.
std::string narrow(const wchar_t* text) {
  std::string narrowed;
  for (; text && *text; ++text) narrowed += *text >= L' ' && *text <= L'~' ? char(*text) : '?';
  return narrowed;
}

}  // namespace

AttachedDevices hid_devices() {
  AttachedDevices attached;
  const std::unique_ptr<hid_device_info, decltype(&hid_free_enumeration)> all(hid_enumerate(0, 0),
                                                                              &hid_free_enumeration);
  for (const hid_device_info* device = all.get(); device; device = device->next)
    attached.devices.push_back({device->vendor_id, device->product_id, narrow(device->product_string),
                                narrow(device->serial_number), device->path ? device->path : ""});
  return attached;
}

}  // namespace insonate
