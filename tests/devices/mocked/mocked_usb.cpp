#include "mocked_usb.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace insonate {
namespace {

std::vector<guint8> descriptors(const MockedUsb::Identity& identity) {
  const auto low = [](int number) { return guint8(number); };
  const auto high = [](int number) { return guint8(number >> 8); };
  return {// Device: USB 2.0, one configuration.
          18, 1, 0, 2, 0, 0, 0, 64, low(identity.vendor), high(identity.vendor), low(identity.product),
          high(identity.product), 0, 1, 0, 0, 0, 1,
          // Configuration of 32 bytes with one interface of two endpoints.
          9, 2, 32, 0, 1, 1, 0, 0x80, 50,                 //
          9, 4, 0, 0, 2, 0xff, 0, 0, 0,                   //
          7, 5, identity.out, 2, low(512), high(512), 0,  //
          7, 5, identity.in, 2, low(512), high(512), 0};
}

gulong address_of(UMockdevIoctlClient* client) {
  guint8* bytes = nullptr;
  gint length = 0;
  umockdev_ioctl_data_retrieve(umockdev_ioctl_client_get_arg(client), &bytes, &length);
  gulong address = 0;
  std::memcpy(&address, bytes, std::min(sizeof address, std::size_t(length)));
  g_free(bytes);
  return address;
}

std::vector<guint8> content(UMockdevIoctlData* data) {
  guint8* bytes = nullptr;
  gint length = 0;
  umockdev_ioctl_data_retrieve(data, &bytes, &length);
  std::vector<guint8> copy(bytes, bytes + length);
  g_free(bytes);
  return copy;
}

void update(UMockdevIoctlData* data, std::size_t offset, int value) {
  umockdev_ioctl_data_update(data, offset, reinterpret_cast<guint8*>(&value), sizeof value);
}

}  // namespace

/// A transfer that the program has handed to the kernel (an "URB").
struct MockedUsb::Transfer {
  gulong address = 0;                   ///< where the program has it
  UMockdevIoctlData* urb = nullptr;     ///< owned
  UMockdevIoctlData* buffer = nullptr;  ///< owned
  bool in = false;
  std::size_t room = 0;
  bool done = false;
  int status = 0;
  Packet bytes;

  Transfer() = default;
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;
  ~Transfer() {
    g_clear_object(&buffer);
    g_clear_object(&urb);
  }
};

MockedUsb::MockedUsb(Testbed& testbed, const Identity& identity, int address) : testbed_(testbed) {
  char dev[32], vendor[8], product[8];
  std::snprintf(dev, sizeof dev, "/dev/bus/usb/001/%03d", address);
  std::snprintf(vendor, sizeof vendor, "%04x", identity.vendor);
  std::snprintf(product, sizeof product, "%04x", identity.product);
  dev_ = dev;
  const std::string number = std::to_string(address), port = "1-" + number;
  gchar* path = umockdev_testbed_add_device(testbed.get(), "usb", port.c_str(), nullptr, "idVendor", vendor,
                                            "idProduct", product, "serial", identity.serial.c_str(), "busnum", "1",
                                            "devnum", number.c_str(), "speed", "480", "bConfigurationValue", "1",
                                            "bNumConfigurations", "1", nullptr, "DEVTYPE", "usb_device", nullptr);
  path_ = path;
  g_free(path);
  std::vector<guint8> described = descriptors(identity);
  umockdev_testbed_set_attribute_binary(testbed.get(), path_.c_str(), "descriptors", described.data(),
                                        gint(described.size()));
  umockdev_testbed_set_property(testbed.get(), path_.c_str(), "DEVNAME", dev);
  node_ = std::make_unique<Node>(testbed.real_path(dev_), false);
  node_->make_writable(false);

  kernel_ = umockdev_ioctl_base_new();
  g_signal_connect(kernel_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
  if (!umockdev_testbed_attach_ioctl(testbed.get(), dev, kernel_, nullptr))
    throw std::runtime_error("umockdev takes no handler for " + dev_);
}

MockedUsb::~MockedUsb() {
  g_signal_handlers_disconnect_by_data(kernel_, this);
  umockdev_testbed_detach_ioctl(testbed_.get(), dev_.c_str(), nullptr);
  umockdev_testbed_remove_device(testbed_.get(), path_.c_str());
  g_object_unref(kernel_);
}

void MockedUsb::send(const Packet& packet) {
  to_send_.push_back(packet);
  serve();
}

void MockedUsb::pull() {
  pulled_ = true;
  serve();
}

void MockedUsb::serve() {
  bool any_done = pulled_;
  for (Transfer& transfer : transfers_) {
    if (!transfer.done && pulled_) {
      transfer.done = true;
      transfer.status = -EPROTO;  // what a pulled cable looks like to a host that has not noticed yet
    } else if (!transfer.done && transfer.in && !to_send_.empty()) {
      transfer.done = true;
      transfer.bytes = to_send_.front();
      transfer.bytes.resize(std::min(transfer.bytes.size(), transfer.room));
      to_send_.pop_front();
    }
    any_done |= transfer.done;
  }
  node_->make_writable(any_done);
}

void MockedUsb::submit(_UMockdevIoctlClient* client) {
  if (pulled_) return umockdev_ioctl_client_complete(client, -1, ENODEV);
  Transfer& transfer = transfers_.emplace_back();
  transfer.address = address_of(client);
  transfer.urb = umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(usbdevfs_urb), nullptr);
  auto urb = usbdevfs_urb();
  if (transfer.urb) {
    std::memcpy(&urb, content(transfer.urb).data(), sizeof urb);
    transfer.room = std::size_t(urb.buffer_length);
    transfer.buffer = umockdev_ioctl_data_resolve(transfer.urb, offsetof(usbdevfs_urb, buffer), transfer.room, nullptr);
  }
  if (!transfer.buffer) {  // the program has ended in the middle of it
    transfers_.pop_back();
    return umockdev_ioctl_client_complete(client, -1, EFAULT);
  }
  transfer.in = (urb.endpoint & 0x80) != 0;
  if (!transfer.in) {
    received_.push_back(content(transfer.buffer));
    transfer.bytes = received_.back();
    transfer.done = true;
  }
  umockdev_ioctl_client_complete(client, 0, 0);
  serve();
}

void MockedUsb::reap(_UMockdevIoctlClient* client) {
  const auto done =
      std::find_if(transfers_.begin(), transfers_.end(), [](const Transfer& transfer) { return transfer.done; });
  if (done == transfers_.end()) return umockdev_ioctl_client_complete(client, -1, pulled_ ? ENODEV : EAGAIN);
  g_autoptr(UMockdevIoctlData) pointer =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(void*), nullptr);
  if (!pointer) return umockdev_ioctl_client_complete(client, -1, EFAULT);
  update(done->urb, offsetof(usbdevfs_urb, status), done->status);
  update(done->urb, offsetof(usbdevfs_urb, actual_length), int(done->bytes.size()));
  if (done->in && !done->bytes.empty())
    umockdev_ioctl_data_update(done->buffer, 0, done->bytes.data(), gint(done->bytes.size()));
  umockdev_ioctl_data_set_ptr(pointer, 0, done->urb);
  umockdev_ioctl_client_complete(client, 0, 0);
  transfers_.erase(done);
  serve();
}

void MockedUsb::discard(_UMockdevIoctlClient* client) {
  const gulong address = address_of(client);
  for (Transfer& transfer : transfers_) {
    if (transfer.address != address || transfer.done) continue;
    transfer.done = true;
    transfer.status = -ENOENT;
    umockdev_ioctl_client_complete(client, 0, 0);
    return serve();
  }
  umockdev_ioctl_client_complete(client, -1, EINVAL);
}

int MockedUsb::on_ioctl(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, void* self) {
  MockedUsb& usb = *static_cast<MockedUsb*>(self);
  switch (umockdev_ioctl_client_get_request(client)) {
    case USBDEVFS_SUBMITURB:
      usb.submit(client);
      break;
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY:
      usb.reap(client);
      break;
    case USBDEVFS_DISCARDURB:
      usb.discard(client);
      break;
    case USBDEVFS_CLAIMINTERFACE:
      umockdev_ioctl_client_complete(client, usb.claimed_ ? -1 : 0, usb.claimed_ ? EBUSY : 0);
      break;
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_CLEAR_HALT:
      umockdev_ioctl_client_complete(client, 0, 0);
      break;
    case USBDEVFS_GETDRIVER:  // no driver of the kernel's has it
    case USBDEVFS_IOCTL:
      umockdev_ioctl_client_complete(client, -1, ENODATA);
      break;
    default:  // of the capabilities too: none
      umockdev_ioctl_client_complete(client, -1, ENOTTY);
  }
  return TRUE;
}

}  // namespace insonate
