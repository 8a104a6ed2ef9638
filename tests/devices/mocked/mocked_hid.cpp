#include "mocked_hid.h"

#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>

namespace insonate {
namespace {

std::string hex(const char* format, unsigned number) {
  char text[32];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

std::string taken(gchar* text) {
  std::string copy = text ? text : "";
  g_free(text);
  return copy;
}

}  // namespace

MockedHid::MockedHid(Testbed& testbed, const Identity& identity, int number)
    : testbed_(testbed), dev_("/dev/hidraw" + std::to_string(number)) {
  const std::string port = "1-" + std::to_string(number + 1), vendor = hex("%04x", identity.vendor),
                    product = hex("%04x", identity.product), bus_number = hex("%04X", unsigned(number));
  // Each under its parent, by its whole path: with parents given as such, umockdev would look for them on this machine.
  usb_path_ = taken(umockdev_testbed_add_device(
      testbed.get(), "usb", port.c_str(), nullptr, "idVendor", vendor.c_str(), "idProduct", product.c_str(), "product",
      identity.name.c_str(), "serial", identity.serial.c_str(), nullptr, "DEVTYPE", "usb_device", nullptr));
  const std::string interface = port + "/" + port + ":1.0";
  taken(umockdev_testbed_add_device(testbed.get(), "usb", interface.c_str(), nullptr, "bInterfaceNumber", "00", nullptr,
                                    "DEVTYPE", "usb_interface", nullptr));
  const std::string hid = interface + "/0003:" + vendor + ":" + product + "." + bus_number;
  const std::string id = "0003:" + hex("%08X", identity.vendor) + ":" + hex("%08X", identity.product);
  taken(umockdev_testbed_add_device(testbed.get(), "hid", hid.c_str(), nullptr, nullptr, "HID_ID", id.c_str(),
                                    "HID_NAME", identity.name.c_str(), "HID_UNIQ", identity.serial.c_str(), nullptr));
  const std::string raw_path = taken(umockdev_testbed_add_device(
      testbed.get(), "hidraw", (hid + "/hidraw/hidraw" + std::to_string(number)).c_str(), nullptr, nullptr, nullptr));
  // Named only now: umockdev would make the node a terminal, which knows no packets and which not every place has.
  umockdev_testbed_set_property(testbed.get(), raw_path.c_str(), "DEVNAME", dev_.c_str());
  node_ = std::make_unique<Node>(testbed.real_path(dev_), true);

  kernel_ = umockdev_ioctl_base_new();
  g_signal_connect(kernel_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
  g_signal_connect(kernel_, "handle-read", G_CALLBACK(on_read), this);
  if (!umockdev_testbed_attach_ioctl(testbed.get(), dev_.c_str(), kernel_, nullptr))
    throw std::runtime_error("umockdev takes no handler for " + dev_);
}

MockedHid::~MockedHid() {
  umockdev_testbed_remove_device(testbed_.get(), usb_path_.c_str());
  if (pulled_) pump([this] { return !node_->is_open_elsewhere(); });
  g_signal_handlers_disconnect_by_data(kernel_, this);
  umockdev_testbed_detach_ioctl(testbed_.get(), dev_.c_str(), nullptr);
  g_object_unref(kernel_);
}

void MockedHid::send(std::deque<Report>& reports) {
  while (!reports.empty() && node_->write(reports.front())) reports.pop_front();
}

void MockedHid::pull() {
  pulled_ = true;
  node_->write({0});  // whoever waits wakes up, and on_read reports
}

int MockedHid::on_ioctl(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, void* self) {
  MockedHid& hid = *static_cast<MockedHid*>(self);
  const gulong request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
  const bool is_size = request == HIDIOCGRDESCSIZE;
  const bool is_feature = _IOC_TYPE(request) == 'H' && _IOC_NR(request) == 6;  // HIDIOCSFEATURE of any length
  if (hid.pulled_ || (!is_size && !is_feature)) {
    umockdev_ioctl_client_complete(client, -1, hid.pulled_ ? ENODEV : ENOTTY);
    return TRUE;
  }
  g_autoptr(UMockdevIoctlData) data = umockdev_ioctl_data_resolve(argument, 0, _IOC_SIZE(request), nullptr);
  if (!data) {  // the program has ended in the middle of it
    umockdev_ioctl_client_complete(client, -1, EFAULT);
  } else if (is_size) {
    int length = 65;
    umockdev_ioctl_data_update(data, 0, reinterpret_cast<guint8*>(&length), sizeof length);
    umockdev_ioctl_client_complete(client, 0, 0);
  } else {
    guint8* bytes = nullptr;
    gint length = 0;
    umockdev_ioctl_data_retrieve(data, &bytes, &length);
    hid.features_.emplace_back(bytes, bytes + length);
    g_free(bytes);
    umockdev_ioctl_client_complete(client, length, 0);
  }
  return TRUE;
}

int MockedHid::on_read(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, void* self) {
  if (!static_cast<MockedHid*>(self)->pulled_) return FALSE;  // the pipe itself answers
  umockdev_ioctl_client_complete(client, -1, EIO);
  return TRUE;
}

}  // namespace insonate
