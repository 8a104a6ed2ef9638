#pragma once

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "devices/transport/transport.h"

namespace insonate {

/// A bus that the test controls. Everything happens when the source asks for it, and the test sets the time.
class ScriptedBus : public DeviceBus {
public:
  using Report = std::vector<std::uint8_t>;

  AttachedDevices attached;
  std::optional<TransportError> refuses;  ///< what opening throws
  std::deque<Report> reports;             ///< what the next reads return; nothing if empty
  bool pulled = false;                    ///< whether the open device is gone
  std::vector<Report> sent;
  std::string opened;  ///< path of the device that was opened last
  Endpoints endpoints;
  int open_now = 0;

  AttachedDevices devices() override { return attached; }

  std::unique_ptr<Transport> open(const AttachedDevice& device, Endpoints used) override {
    if (refuses) throw *refuses;
    opened = device.path;
    endpoints = used;
    return std::make_unique<Line>(*this, device);
  }

private:
  class Line : public Transport {
  public:
    Line(ScriptedBus& bus, AttachedDevice device) : bus_(bus), device_(std::move(device)) { ++bus_.open_now; }
    ~Line() override { --bus_.open_now; }

    std::size_t read(std::span<std::uint8_t> into, std::chrono::milliseconds) override {
      if (bus_.pulled) throw gone(device_, "Input/output error");
      if (bus_.reports.empty()) return 0;
      const Report report = bus_.reports.front();
      bus_.reports.pop_front();
      const std::size_t length = std::min(report.size(), into.size());
      std::copy_n(report.begin(), length, into.begin());
      return length;
    }

    void send(std::span<const std::uint8_t> bytes) override {
      if (bus_.pulled) throw gone(device_, "No such device");
      bus_.sent.emplace_back(bytes.begin(), bytes.end());
    }

  private:
    ScriptedBus& bus_;
    AttachedDevice device_;
  };
};

}  // namespace insonate
