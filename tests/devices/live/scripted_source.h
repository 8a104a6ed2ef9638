#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "devices/live/live_source.h"
#include "devices/live/steady_clock.h"
#include "devices/tracker.h"

namespace insonate {

/// A device that the test controls: plugged in or not, silent or not. Shared with the source on its thread.
struct ScriptedDevice {
  std::atomic<bool> plugged_in{true};
  std::atomic<bool> silent{false};
  std::atomic<int> opened{0}, closed{0};
  std::atomic<std::uint32_t> sent{0};  ///< samples so far; each carries its number, counted from 1, as x and as buttons
  std::atomic<int> in_one_read{1};
  bool relative = false;  ///< whether it has no absolute position

  void note(const std::string& text) {
    const std::lock_guard lock(mutex_);
    note_ = text;
  }
  std::string note() const {
    const std::lock_guard lock(mutex_);
    return note_;
  }

private:
  mutable std::mutex mutex_;
  std::string note_;
};

class ScriptedSource : public LiveSource {
public:
  explicit ScriptedSource(ScriptedDevice& device) : device_(device) {}

  std::string name() const override { return "a scripted device"; }
  bool relative() const override { return device_.relative; }

  void open() override {
    if (!device_.plugged_in) throw SourceGone("The scripted device is not plugged in.");
    ++device_.opened;
  }

  void read(std::chrono::milliseconds timeout, LiveBatch& batch) override {
    std::this_thread::sleep_for(std::min(timeout, std::chrono::milliseconds(1)));
    if (!device_.plugged_in) throw SourceGone("The scripted device was pulled out.");
    batch.note = device_.note();
    if (device_.silent) return;
    const double now_s = steady_now_s();
    for (int i = 0; i < device_.in_one_read; ++i) {
      ProbeSample sample;
      sample.time_s = now_s;
      sample.status = PoseStatus::ok;
      sample.buttons = ++device_.sent;
      sample.patient_from_probe.translation.x = sample.buttons;
      batch.samples.push_back(sample);
    }
  }

  void close() noexcept override { ++device_.closed; }

private:
  ScriptedDevice& device_;
};

/// Polls like a render thread until `done`. Returns false if that takes longer than the slowest machine needs.
inline bool poll_until(Tracker& tracker, std::vector<ProbeSample>& samples, const std::function<bool()>& done) {
  const double limit_s = steady_now_s() + 60;
  while (steady_now_s() < limit_s) {
    tracker.poll(steady_now_s(), samples);
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

}  // namespace insonate
