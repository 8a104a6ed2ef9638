#include "devices/usb/usb_bus.h"

#include <libusb.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

namespace insonate {
namespace {

constexpr int kInterface = 0;
constexpr unsigned kSendTimeout_ms = 200;

/// A separate context for each listing and each open device, so that a new listing shows what was plugged in since.
class Context {
public:
  Context() : problem_(libusb_init(&context_)) {}
  ~Context() {
    if (problem_ == LIBUSB_SUCCESS) libusb_exit(context_);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  libusb_context* get() const { return context_; }
  int problem() const { return problem_; }

private:
  libusb_context* context_ = nullptr;
  int problem_;
};

/// The devices of a context, while the list lives.
class List {
public:
  explicit List(const Context& context) : count_(libusb_get_device_list(context.get(), &list_)) {}
  ~List() {
    if (count_ >= 0) libusb_free_device_list(list_, 1);
  }
  List(const List&) = delete;
  List& operator=(const List&) = delete;
  std::span<libusb_device* const> devices() const { return {list_, count_ < 0 ? 0 : std::size_t(count_)}; }
  int problem() const { return count_ < 0 ? int(count_) : int(LIBUSB_SUCCESS); }

private:
  libusb_device** list_ = nullptr;
  ssize_t count_;
};

std::string place(libusb_device* device) {
  return "bus " + std::to_string(libusb_get_bus_number(device)) + ", address " +
         std::to_string(libusb_get_device_address(device));
}

/// Returns what the kernel read from the device when it was plugged in. Asking the device itself would require opening
/// it.
std::string kernel_knows(libusb_device* device, const char* attribute) {
  std::array<std::uint8_t, 7> ports;  // maximum depth of the USB tree
  const int depth = libusb_get_port_numbers(device, ports.data(), int(ports.size()));
  if (depth <= 0) return "";
  std::string name = std::to_string(libusb_get_bus_number(device)) + "-" + std::to_string(ports[0]);
  for (int i = 1; i < depth; ++i) name += "." + std::to_string(ports[std::size_t(i)]);
  std::ifstream file("/sys/bus/usb/devices/" + name + "/" + attribute);
  std::string line;
  std::getline(file, line);
  return line;
}

class UsbTransport : public Transport {
public:
  UsbTransport(std::unique_ptr<Context> context, AttachedDevice device, libusb_device_handle* handle,
               Endpoints endpoints)
      : context_(std::move(context)),
        device_(std::move(device)),
        handle_(handle, &libusb_close),
        endpoints_(endpoints) {}

  ~UsbTransport() override { libusb_release_interface(handle_.get(), kInterface); }

  /// Throws TransportError.
  void claim() {
    libusb_set_auto_detach_kernel_driver(handle_.get(), 1);
    const int error = libusb_claim_interface(handle_.get(), kInterface);
    if (error == LIBUSB_ERROR_BUSY) throw busy(device_);
    if (error != LIBUSB_SUCCESS) fail(error);
  }

  std::size_t read(std::span<std::uint8_t> into, std::chrono::milliseconds timeout) override {
    int got = 0;
    // To libusb a timeout of 0 means no timeout: it would wait forever.
    const auto wait_ms = unsigned(std::max<std::chrono::milliseconds::rep>(timeout.count(), 1));
    const int error = libusb_bulk_transfer(handle_.get(), endpoints_.in, into.data(), int(into.size()), &got, wait_ms);
    if (error == LIBUSB_ERROR_PIPE)
      libusb_clear_halt(handle_.get(), endpoints_.in);
    else if (error != LIBUSB_SUCCESS && error != LIBUSB_ERROR_TIMEOUT && error != LIBUSB_ERROR_OVERFLOW)
      fail(error);
    return std::size_t(got);
  }

  void send(std::span<const std::uint8_t> bytes) override {
    int sent = 0;
    // libusb takes a pointer to non-const, but only reads.
    const int error = libusb_bulk_transfer(handle_.get(), endpoints_.out, const_cast<std::uint8_t*>(bytes.data()),
                                           int(bytes.size()), &sent, kSendTimeout_ms);
    if (error == LIBUSB_ERROR_PIPE) libusb_clear_halt(handle_.get(), endpoints_.out);
    if (error == LIBUSB_ERROR_PIPE || error == LIBUSB_ERROR_TIMEOUT) throw refused(device_, libusb_strerror(error));
    if (error != LIBUSB_SUCCESS) fail(error);
  }

private:
  /// A device that is pulled out during a transfer causes an input/output error at least as often as its own error. So
  /// every error without a specific meaning counts as a possible loss.
  [[noreturn]] void fail(int error) const { throw gone(device_, libusb_strerror(error)); }

  std::unique_ptr<Context> context_;  // must outlive the handle
  AttachedDevice device_;
  std::unique_ptr<libusb_device_handle, decltype(&libusb_close)> handle_;
  Endpoints endpoints_;
};

}  // namespace

AttachedDevices UsbBus::devices() {
  AttachedDevices attached;
  const Context context;
  if (context.problem() != LIBUSB_SUCCESS) {
    attached.problem = libusb_strerror(context.problem());
    return attached;
  }
  const List list(context);
  if (list.problem() != LIBUSB_SUCCESS) attached.problem = libusb_strerror(list.problem());
  for (libusb_device* device : list.devices()) {
    libusb_device_descriptor descriptor;
    if (libusb_get_device_descriptor(device, &descriptor) != LIBUSB_SUCCESS) continue;
    attached.devices.push_back({descriptor.idVendor, descriptor.idProduct, kernel_knows(device, "product"),
                                kernel_knows(device, "serial"), place(device)});
  }
  return attached;
}

std::unique_ptr<Transport> UsbBus::open(const AttachedDevice& device, Endpoints endpoints) {
  auto context = std::make_unique<Context>();
  if (context->problem() != LIBUSB_SUCCESS) throw gone(device, libusb_strerror(context->problem()));
  libusb_device_handle* handle = nullptr;
  {
    // The list is freed before the transport is made, because a transport that fails destroys the context.
    const List list(*context);
    for (libusb_device* candidate : list.devices()) {
      if (place(candidate) != device.path) continue;
      const int error = libusb_open(candidate, &handle);
      if (error == LIBUSB_ERROR_ACCESS) throw forbidden(device);
      if (error != LIBUSB_SUCCESS) throw gone(device, libusb_strerror(error));
      break;
    }
  }
  if (!handle) throw gone(device, "it is no longer there");
  auto transport = std::make_unique<UsbTransport>(std::move(context), device, handle, endpoints);
  transport->claim();
  return transport;
}

}  // namespace insonate
