#pragma once

#include "testbed.h"

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

struct _UMockdevIoctlBase;
struct _UMockdevIoctlClient;

namespace insonate {

/// A HID that is plugged into a test bed while the object exists.
class MockedHid {
public:
  using Report = std::vector<unsigned char>;

  struct Identity {
    std::uint16_t vendor, product;
    std::string name, serial;
  };

  /// `number` is that of /dev/hidrawN. A number cannot be reused in the same test bed.
  MockedHid(Testbed& testbed, const Identity& identity, int number);
  ~MockedHid();
  MockedHid(const MockedHid&) = delete;
  MockedHid& operator=(const MockedHid&) = delete;

  /// Sends as many of `reports` as fit, and removes them from `reports`.
  void send(std::deque<Report>& reports);

  /// Makes the device fail for every process that has it open. It stays in the lists until it is destroyed. The
  /// destructor waits until every other process has closed it: umockdev ends a program that it cuts off in the middle
  /// of a call.
  void pull();

  Node& node() { return *node_; }
  const std::vector<Report>& features() const { return features_; }  ///< feature reports that it has received

private:
  static int on_ioctl(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, void* self);
  static int on_read(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, void* self);

  Testbed& testbed_;
  std::string dev_, usb_path_;
  std::unique_ptr<Node> node_;
  _UMockdevIoctlBase* kernel_;
  std::vector<Report> features_;
  bool pulled_ = false;
};

}  // namespace insonate
