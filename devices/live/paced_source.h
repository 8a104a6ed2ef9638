#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "devices/live/live_source.h"

namespace insonate {

/// Gives made-up or recorded samples in real time at a steady rate, each stamped when it is given, as a device would:
/// to try on a desk what else needs one, and to measure.
class PacedSource : public LiveSource {
public:
  /// `sample` is called with 0, 1, 2... on the thread that reads; the time of what it returns is replaced.
  PacedSource(std::string name, std::function<PoseSample(std::uint64_t index)> sample, double rate_hz);

  std::string name() const override { return name_; }
  void open() override {}
  void read(std::chrono::milliseconds timeout, LiveBatch& batch) override;
  void close() noexcept override {}

  /// How many samples were given; by anybody.
  std::uint64_t given() const { return given_.load(std::memory_order_relaxed); }

private:
  std::string name_;
  std::function<PoseSample(std::uint64_t)> sample_;
  double rate_hz_;
  std::optional<double> start_s_;
  std::atomic<std::uint64_t> given_{0};
};

}  // namespace insonate
