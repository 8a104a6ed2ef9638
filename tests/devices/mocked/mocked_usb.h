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

/// A USB device with one bulk endpoint each way that is plugged into a test bed for as long as it lives; it answers
/// libusb as the kernel's usbfs does.
class MockedUsb {
public:
  using Packet = std::vector<unsigned char>;

  struct Identity {
    std::uint16_t vendor, product;
    std::string serial;
    std::uint8_t out, in;  ///< endpoints
  };

  /// `address` on bus 1, from 1 to 127. One that was used before cannot be used again in the same test bed.
  MockedUsb(Testbed& testbed, const Identity& identity, int address);
  ~MockedUsb();
  MockedUsb(const MockedUsb&) = delete;
  MockedUsb& operator=(const MockedUsb&) = delete;

  /// Each is the answer to one transfer.
  void send(const Packet& packet);

  /// Who has it open is told that it is gone: transfers under way fail, further ones find no device.
  void pull();

  /// Whether another program has claimed it.
  void claim_elsewhere(bool claimed) { claimed_ = claimed; }

  Node& node() { return *node_; }
  const std::vector<Packet>& received() const { return received_; }

private:
  struct Transfer;

  static int on_ioctl(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, void* self);
  void submit(_UMockdevIoctlClient* client);
  void reap(_UMockdevIoctlClient* client);
  void discard(_UMockdevIoctlClient* client);
  void serve();  ///< ends the transfers that can end, and tells who waits

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
