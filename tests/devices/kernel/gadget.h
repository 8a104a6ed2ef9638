#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

/// USB devices that this machine's kernel simulates (configfs, on the ports of dummy_hcd) and connects to itself. Its
/// own usbhid, hidraw and usbfs serve them like real devices. Needs root, and a machine that nobody else uses.
namespace insonate::kernel {

using Packet = std::vector<unsigned char>;

struct Identity {
  std::uint16_t vendor, product;
  std::string name, serial;
};

/// A device in configfs, plugged into a port while the object exists.
class Gadget {
public:
  /// @param function  its single function, named as in configfs: "hid.hydra"
  Gadget(const Identity& identity, const std::string& function);
  ~Gadget();
  Gadget(const Gadget&) = delete;
  Gadget& operator=(const Gadget&) = delete;

  std::filesystem::path function_folder() const;
  /// @param port  0 or 1; each takes one device
  void plug(int port);
  void pull();

private:
  std::filesystem::path folder_;
  std::string function_;
  bool plugged_ = false;
};

/// A HID with 52-byte input reports and 90-byte feature reports without report numbers, like the Hydra's interface.
class HidGadget {
public:
  HidGadget(const Identity& identity, int port);
  ~HidGadget();

  /// Waits until the host has asked for the report. Returns false if the device is unplugged before.
  bool send(const Packet& report);
  /// Returns the feature reports that the host has sent so far.
  const std::vector<Packet>& features();

private:
  Gadget gadget_;
  int fd_ = -1;
  std::vector<Packet> features_;
};

/// A device with a bulk endpoint each way, out at 0x02 and in at 0x81, served from user space (FunctionFS).
class BulkGadget {
public:
  BulkGadget(const Identity& identity, int port);
  ~BulkGadget();

  /// Queues a packet. Each packet answers one transfer, in order.
  void send(const Packet& packet);
  /// Returns the packets that the host has sent so far.
  std::vector<Packet> received();

private:
  void serve_in();
  void serve_out();

  Gadget gadget_;
  std::filesystem::path files_;
  int control_ = -1, in_ = -1, out_ = -1;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Packet> to_send_;
  std::vector<Packet> received_;
  bool ending_ = false;
  std::thread sender_, receiver_;
};

}  // namespace insonate::kernel
