// insonate-devices list: lists the kinds of tracker, and the connected ones.

#include <cstdio>
#include <memory>
#include <string>

#include "devices/hid/hid_bus.h"
#include "devices/registry.h"
#include "devices/usb/usb_bus.h"
#include "tools/devices/commands.h"

namespace insonate::devices {
namespace {

/// Returns the model of a device that one of the trackers uses, or could once it is ready; nullptr if none does.
const DeviceKind::Model* known_model(Bus bus, const AttachedDevice& device) {
  for (const TrackerKind& kind : tracker_kinds())
    if (kind.device && kind.device->bus == bus)
      if (const DeviceKind::Model* model = kind.device->find(device.vendor, device.product)) return model;
  return nullptr;
}

/// Prints the known trackers of a bus, or with `all` every device on it. Returns the number of known ones.
int list_bus(Bus bus, const char* bus_name, const AttachedDevices& attached, bool all) {
  int known_ones = 0;
  if (!attached.problem.empty()) std::printf("  %s cannot be asked: %s\n", bus_name, attached.problem.c_str());
  for (const AttachedDevice& device : attached.devices) {
    const DeviceKind::Model* known = known_model(bus, device);
    if (!known && !all) continue;
    known_ones += known != nullptr;
    const std::string name = known ? std::string(known->name) : device.name.empty() ? "a device" : device.name;
    std::printf("  %-32s %s %04x:%04x  %s", name.c_str(), bus_name, device.vendor, device.product, device.path.c_str());
    if (!device.serial.empty()) std::printf("  serial %s", device.serial.c_str());
    if (known && !known->note.empty()) std::printf("  (%s)", std::string(known->note).c_str());
    std::printf("\n");
  }
  return known_ones;
}

int list(bool all) {
  std::printf("Trackers that this version can use, as --tracker takes them:\n");
  for (const TrackerKind& kind : tracker_kinds())
    std::printf("  %-62s %s\n", std::string(kind.form).c_str(), std::string(kind.summary).c_str());
  std::printf("\nPlugged in:\n");
  const int known =
      list_bus(Bus::hid, "HID", HidBus().devices(), all) + list_bus(Bus::usb, "USB", UsbBus().devices(), all);
  if (known == 0) std::printf("  no tracker that is known here%s\n", all ? "" : " (--all lists every device)");
  return 0;
}

}  // namespace

Command list_command(CLI::App& program) {
  const auto all = std::make_shared<bool>(false);
  CLI::App* parser = program.add_subcommand("list", "List the kinds of tracker, and the trackers that are plugged in");
  parser->add_flag("--all", *all, "List every HID and USB device, known or not");
  return {parser, [all] { return list(*all); }};
}

}  // namespace insonate::devices
