#pragma once

#include "testbed.h"

#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <string>
#include <vector>

struct _UMockdevIoctlBase;
struct _UMockdevIoctlClient;
struct _UMockdevIoctlData;

namespace insonate {

/// A USB device with one bulk endpoint in each direction, plugged into a test bed while the object exists. It answers
/// libusb like the kernel's usbfs.
class MockedUsb {
public:
  using Packet = std::vector<unsigned char>;

  struct Identity {
    std::uint16_t vendor, product;
    std::string serial;
    std::uint8_t out, in;  ///< endpoints
  };

  /// `address` on bus 1, from 1 to 127. An address cannot be reused in the same test bed.
  MockedUsb(Testbed& testbed, const Identity& identity, int address);
  ~MockedUsb();
  MockedUsb(const MockedUsb&) = delete;
  MockedUsb& operator=(const MockedUsb&) = delete;

  /// Queues a packet. Each packet answers one transfer.
  void send(const Packet& packet);

  /// Makes the device unavailable: pending transfers fail, further ones find no device.
  void pull();

  /// Sets whether another program has claimed it.
  void claim_elsewhere(bool claimed) { claimed_ = claimed; }

  Node& node() { return *node_; }
  const std::vector<Packet>& received() const { return received_; }

private:
  struct Transfer;

  static int on_ioctl(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, void* self);
  void submit(_UMockdevIoctlClient* client);
  void reap(_UMockdevIoctlClient* client);
  void discard(_UMockdevIoctlClient* client);
  void serve();  ///< completes the transfers that can complete, and notifies the processes that wait

  Testbed& testbed_;
  std::string dev_, path_;
  std::unique_ptr<Node> node_;
  _UMockdevIoctlBase* kernel_;
  std::deque<Packet> to_send_;
  std::vector<Packet> received_;
  std::list<Transfer> transfers_;
  bool pulled_ = false, claimed_ = false;
};

}  // namespace insonate
