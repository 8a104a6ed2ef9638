#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "devices/live/live_source.h"

namespace insonate {

/// Delivers synthetic or recorded samples in real time at a steady rate, stamped when they are delivered, as from a
/// device. It replaces a device in trials and in measurements.
class PacedSource : public LiveSource {
public:
  /// The reading thread calls `sample` with 0, 1, 2... and replaces the time of the returned sample.
  PacedSource(std::string name, std::function<ProbeSample(std::uint64_t index)> sample, double rate_hz);

  std::string name() const override { return name_; }
  void open() override {}
  void read(std::chrono::milliseconds timeout, LiveBatch& batch) override;
  void close() noexcept override {}

  /// Returns how many samples were delivered. Any thread may call it.
  std::uint64_t given() const { return given_.load(std::memory_order_relaxed); }

private:
  std::string name_;
  std::function<ProbeSample(std::uint64_t)> sample_;
  double rate_hz_;
  std::optional<double> start_s_;
  std::atomic<std::uint64_t> given_{0};
};

}  // namespace insonate
