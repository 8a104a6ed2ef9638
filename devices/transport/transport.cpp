#include "devices/transport/transport.h"

#include <cstdio>

namespace insonate {
namespace {

std::string numbers(const AttachedDevice& device) {
  char text[16];
  std::snprintf(text, sizeof text, "%04x:%04x", device.vendor, device.product);
  return text;
}

std::string named(const AttachedDevice& device) {
  return "The device " + numbers(device) + " at " + device.path;
}

}  // namespace

TransportError forbidden(const AttachedDevice& device) {
  char match[96];
  // A HID device is opened through its own node, whose parent has the numbers. A USB device is opened through the node
  // that has them.
  const bool hid = device.path.starts_with('/');
  std::snprintf(match, sizeof match,
                hid ? R"(KERNEL=="hidraw*", ATTRS{idVendor}=="%04x", ATTRS{idProduct}=="%04x")"
                    : R"(SUBSYSTEM=="usb", ATTR{idVendor}=="%04x", ATTR{idProduct}=="%04x")",
                unsigned{device.vendor}, unsigned{device.product});
  return {TransportFault::forbidden,
          named(device) + " may not be opened by this user: install the package or run tools/install-udev-rule, " +
              "plug it in again, or put this line into /etc/udev/rules.d/70-insonate.rules: " + match +
              R"(, TAG+="uaccess", MODE="0660".)"};
}

TransportError busy(const AttachedDevice& device) {
  return {TransportFault::busy, named(device) + " is in use: close the other program that has it."};
}

TransportError gone(const AttachedDevice& device, const std::string& why) {
  return {TransportFault::gone, named(device) + " was lost (" + why + "): check its cable."};
}

TransportError refused(const AttachedDevice& device, const std::string& why) {
  return {TransportFault::refused, named(device) + " does not do what it is asked (" + why + "): plug it in again."};
}

}  // namespace insonate
