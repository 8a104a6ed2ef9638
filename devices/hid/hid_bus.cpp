#include "devices/hid/hid_bus.h"

#include <hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace insonate {
namespace {

/// Converts a device's own text to printable ASCII; other characters become '?'.
std::string narrow(const wchar_t* text) {
  std::string narrowed;
  for (; text && *text; ++text) narrowed += *text >= L' ' && *text <= L'~' ? char(*text) : '?';
  return narrowed;
}

class HidTransport : public Transport {
public:
  HidTransport(AttachedDevice device, hid_device* handle) : device_(std::move(device)), handle_(handle, &hid_close) {}

  std::size_t read(std::span<std::uint8_t> into, std::chrono::milliseconds timeout) override {
    // To hidapi a negative timeout means no timeout: it would wait forever.
    const auto wait_ms = int(std::max<std::chrono::milliseconds::rep>(timeout.count(), 1));
    const int got = hid_read_timeout(handle_.get(), into.data(), into.size(), wait_ms);
    if (got < 0) throw gone(device_, narrow(hid_error(handle_.get())));
    return std::size_t(got);
  }

  void send(std::span<const std::uint8_t> bytes) override {
    errno = 0;
    if (hid_send_feature_report(handle_.get(), bytes.data(), bytes.size()) >= 0) return;
    const int why = errno;
    if (why == ENODEV || why == EIO || why == ENOENT) throw gone(device_, std::strerror(why));
    throw refused(device_, why ? std::strerror(why) : narrow(hid_error(handle_.get())));
  }

private:
  AttachedDevice device_;
  std::unique_ptr<hid_device, decltype(&hid_close)> handle_;
};

}  // namespace

AttachedDevices HidBus::devices() {
  AttachedDevices attached;
  const std::unique_ptr<hid_device_info, decltype(&hid_free_enumeration)> all(hid_enumerate(0, 0),
                                                                              &hid_free_enumeration);
  for (const hid_device_info* device = all.get(); device; device = device->next)
    attached.devices.push_back({device->vendor_id, device->product_id, narrow(device->product_string),
                                narrow(device->serial_number), device->path ? device->path : "",
                                device->interface_number});
  return attached;
}

std::unique_ptr<Transport> HidBus::open(const AttachedDevice& device, Endpoints) {
  if (hid_device* handle = hid_open_path(device.path.c_str())) return std::make_unique<HidTransport>(device, handle);
  // hidapi reports the reason only as text, in the user's language. Accessing the file again gives the errno.
  if (access(device.path.c_str(), R_OK | W_OK) == 0) throw busy(device);
  if (errno == EACCES || errno == EPERM) throw forbidden(device);
  throw gone(device, std::strerror(errno));
}

}  // namespace insonate
