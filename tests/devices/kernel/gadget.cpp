#include "tests/devices/kernel/gadget.h"

#include <fcntl.h>
#include <linux/usb/ch9.h>
#include <linux/usb/functionfs.h>
#include <poll.h>
#include <sys/mount.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace insonate::kernel {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t kBulkPacket = 512;
constexpr int kInputBytes = 52, kFeatureBytes = 90;

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text << std::flush;
  if (!out) throw std::runtime_error("cannot write '" + text + "' to " + file.string() + ": " + std::strerror(errno));
}

std::string hex(unsigned number) {
  char text[8];
  std::snprintf(text, sizeof text, "0x%04x", number);
  return text;
}

/// A node that the kernel makes a moment after it was asked for.
int open_when_there(const fs::path& file, int flags) {
  for (int tries = 0; tries < 1000; ++tries) {
    const int fd = open(file.c_str(), flags | O_CLOEXEC);
    if (fd >= 0) return fd;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw std::runtime_error("cannot open " + file.string() + ": " + std::strerror(errno));
}

/// Vendor-defined collection of one input and one feature report of bytes (USB HID 1.11, section 6.2.2).
const Packet kReportDescriptor = {0x06, 0x00, 0xff, 0x09,          0x01, 0xa1, 0x01,        0x15, 0x00,
                                  0x26, 0xff, 0x00, 0x75,          0x08, 0x95, kInputBytes, 0x09, 0x01,
                                  0x81, 0x02, 0x95, kFeatureBytes, 0x09, 0x01, 0xb1,        0x02, 0xc0};

struct Descriptors {
  usb_functionfs_descs_head_v2 head;
  __le32 full_speed, high_speed;
  struct Interface {
    usb_interface_descriptor interface;
    usb_endpoint_descriptor_no_audio in, out;
  } __attribute__((packed)) full, high;
} __attribute__((packed));

Descriptors bulk_descriptors() {
  Descriptors all{};
  all.head = {FUNCTIONFS_DESCRIPTORS_MAGIC_V2, sizeof all, FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC};
  all.full_speed = all.high_speed = 3;
  const auto endpoint = [](std::uint8_t address, std::uint16_t packet) {
    usb_endpoint_descriptor_no_audio described{};
    described.bLength = sizeof described;
    described.bDescriptorType = USB_DT_ENDPOINT;
    described.bEndpointAddress = address;
    described.bmAttributes = USB_ENDPOINT_XFER_BULK;
    described.wMaxPacketSize = packet;
    return described;
  };
  for (auto* speed : {&all.full, &all.high}) {
    speed->interface.bLength = sizeof speed->interface;
    speed->interface.bDescriptorType = USB_DT_INTERFACE;
    speed->interface.bNumEndpoints = 2;
    speed->interface.bInterfaceClass = USB_CLASS_VENDOR_SPEC;
    const std::uint16_t packet = speed == &all.high ? kBulkPacket : 64;
    speed->in = endpoint(0x81, packet);
    speed->out = endpoint(0x02, packet);
  }
  return all;
}

void write_whole(int fd, const void* bytes, std::size_t count, const char* what) {
  if (write(fd, bytes, count) != ssize_t(count))
    throw std::runtime_error(std::string("the kernel does not take the ") + what + ": " + std::strerror(errno));
}

}  // namespace

Gadget::Gadget(const Identity& identity, const std::string& function)
    : folder_("/sys/kernel/config/usb_gadget/" + function.substr(function.find('.') + 1)), function_(function) {
  fs::create_directory(folder_);
  write_text(folder_ / "idVendor", hex(identity.vendor));
  write_text(folder_ / "idProduct", hex(identity.product));
  fs::create_directory(folder_ / "strings/0x409");
  write_text(folder_ / "strings/0x409/product", identity.name);
  write_text(folder_ / "strings/0x409/serialnumber", identity.serial);
  fs::create_directory(folder_ / "configs/c.1");
  fs::create_directory(function_folder());
}

Gadget::~Gadget() {
  pull();
  std::error_code ignored;  // what is left over is of a machine that ends with its test
  fs::remove(folder_ / "configs/c.1" / function_, ignored);
  for (const char* part : {"configs/c.1", "strings/0x409"}) rmdir((folder_ / part).c_str());
  rmdir(function_folder().c_str());
  rmdir(folder_.c_str());
}

fs::path Gadget::function_folder() const {
  return folder_ / "functions" / function_;
}

void Gadget::plug(int port) {
  write_text(folder_ / "UDC", "dummy_udc." + std::to_string(port));
  plugged_ = true;
}

void Gadget::pull() {
  if (plugged_) write_text(folder_ / "UDC", "\n");
  plugged_ = false;
}

HidGadget::HidGadget(const Identity& identity, int port) : gadget_(identity, "hid.port" + std::to_string(port)) {
  const fs::path function = gadget_.function_folder();
  write_text(function / "no_out_endpoint", "1");  // feature reports come by the control endpoint
  write_text(function / "report_length", std::to_string(kInputBytes));
  std::ofstream(function / "report_desc", std::ios::binary)
      .write(reinterpret_cast<const char*>(kReportDescriptor.data()), std::streamsize(kReportDescriptor.size()));
  fs::create_symlink(function, function.parent_path().parent_path() / "configs/c.1" / function.filename());
  gadget_.plug(port);
  std::string number;
  std::ifstream(function / "dev") >> number;  // major:minor, and the minor is that of the node
  fd_ = open_when_there("/dev/hidg" + number.substr(number.find(':') + 1), O_RDWR | O_NONBLOCK);
}

HidGadget::~HidGadget() {
  gadget_.pull();
  close(fd_);
}

bool HidGadget::send(const Packet& report) {
  for (;;) {
    if (write(fd_, report.data(), report.size()) == ssize_t(report.size())) return true;
    if (errno != EAGAIN) return false;
    pollfd ready{fd_, POLLOUT, 0};
    if (poll(&ready, 1, 10000) <= 0) return false;
  }
}

const std::vector<Packet>& HidGadget::features() {
  std::array<unsigned char, 4096> bytes;
  for (ssize_t got = 0; (got = read(fd_, bytes.data(), bytes.size())) > 0;)
    features_.emplace_back(bytes.begin(), bytes.begin() + got);
  return features_;
}

BulkGadget::BulkGadget(const Identity& identity, int port)
    : gadget_(identity, "ffs.port" + std::to_string(port)), files_("/dev/ffs" + std::to_string(port)) {
  fs::create_directory(files_);
  if (mount(("port" + std::to_string(port)).c_str(), files_.c_str(), "functionfs", 0, nullptr) != 0)
    throw std::runtime_error(std::string("FunctionFS does not mount: ") + std::strerror(errno));
  control_ = open_when_there(files_ / "ep0", O_RDWR);
  const Descriptors described = bulk_descriptors();
  write_whole(control_, &described, sizeof described, "descriptors");
  const usb_functionfs_strings_head strings{FUNCTIONFS_STRINGS_MAGIC, sizeof strings, 0, 0};
  write_whole(control_, &strings, sizeof strings, "strings");
  const fs::path function = gadget_.function_folder();
  fs::create_symlink(function, function.parent_path().parent_path() / "configs/c.1" / function.filename());
  gadget_.plug(port);
  in_ = open_when_there(files_ / "ep1", O_RDWR);
  out_ = open_when_there(files_ / "ep2", O_RDWR);
  sender_ = std::thread([this] { serve_in(); });
  receiver_ = std::thread([this] { serve_out(); });
}

BulkGadget::~BulkGadget() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  gadget_.pull();  // ends the transfers that the threads wait in
  sender_.join();
  receiver_.join();
  for (const int fd : {in_, out_, control_}) close(fd);
  umount(files_.c_str());
  rmdir(files_.c_str());
}

void BulkGadget::send(const Packet& packet) {
  {
    const std::lock_guard lock(mutex_);
    to_send_.push_back(packet);
  }
  changed_.notify_all();
}

std::vector<Packet> BulkGadget::received() {
  const std::lock_guard lock(mutex_);
  return received_;
}

void BulkGadget::serve_in() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ending_ || !to_send_.empty(); });
    if (ending_) return;
    const Packet packet = to_send_.front();
    to_send_.pop_front();
    lock.unlock();
    const bool sent = write(in_, packet.data(), packet.size()) == ssize_t(packet.size());
    lock.lock();
    if (!sent) return;
  }
}

void BulkGadget::serve_out() {
  std::array<unsigned char, kBulkPacket> bytes;
  for (;;) {
    const ssize_t got = read(out_, bytes.data(), bytes.size());
    if (got < 0) return;
    const std::lock_guard lock(mutex_);
    received_.emplace_back(bytes.begin(), bytes.begin() + got);
  }
}

}  // namespace insonate::kernel
