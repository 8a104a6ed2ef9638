#include "devices/usb/usb_devices.h"

#include <libusb.h>

namespace insonate {

AttachedDevices usb_devices() {
  AttachedDevices attached;
  libusb_context* context = nullptr;
  if (const int error = libusb_init(&context)) {
    attached.problem = libusb_strerror(error);
    return attached;
  }
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  if (count < 0) attached.problem = libusb_strerror(int(count));
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor;
    if (libusb_get_device_descriptor(list[i], &descriptor) != LIBUSB_SUCCESS) continue;
    attached.devices.push_back({descriptor.idVendor, descriptor.idProduct, "", "",
                                "bus " + std::to_string(libusb_get_bus_number(list[i])) + ", address " +
                                    std::to_string(libusb_get_device_address(list[i]))});
  }
  if (count >= 0) libusb_free_device_list(list, 1);
  libusb_exit(context);
  return attached;
}

}  // namespace insonate
