#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "devices/filter/sample_filters.h"
#include "devices/live/live_source.h"
#include "devices/tracker.h"

namespace insonate {

/// Reads a device on its own thread. poll() never waits for it, and the destructor waits at most `ending`.
///
/// Its clock is steady_now_s(), and it must be polled with that. The thread starts with the first poll, so a tracker
/// that is only asked for its name opens nothing. The thread ends with the tracker. If a device does not close within
/// `ending`, its thread is detached. The thread of the next tracker waits for detached threads before it opens its
/// device, so no device is opened while it is still being closed.
///
/// After the first sample, silence is reported by samples too. If nothing has arrived for `silence`, because the device
/// is gone or silent, the tracker adds a sample `missing`, and further ones every `heartbeat` while the silence lasts.
/// So the time of an exam continues without its tracker.
class LiveTracker : public Tracker {
public:
  /// Limits and intervals of a LiveTracker; the tests change them.
  struct Options {
    /// Samples that can wait for the next poll: half a second of eight sensors at 1000 Hz.
    std::size_t capacity = 4096;
    std::chrono::milliseconds read{20};          ///< the longest wait of a read
    std::chrono::milliseconds first_pause{250};  ///< before a source is opened again; doubles up to longest_pause
    std::chrono::milliseconds longest_pause{2000};
    std::chrono::milliseconds silence{500};
    std::chrono::milliseconds heartbeat{100};
    std::chrono::milliseconds ending{40};  ///< the longest wait of the destructor
  };

  LiveTracker(std::unique_ptr<LiveSource> source, const Options& options);
  explicit LiveTracker(std::unique_ptr<LiveSource> source) : LiveTracker(std::move(source), Options()) {}
  ~LiveTracker() override;

  /// Sets the filters that the thread applies to each sample before it is returned; none by default. Call it before the
  /// first poll.
  void set_filters(const FilterSettings& settings);
  const FilterSettings& filters() const;

  bool record_raw(const std::shared_ptr<RawTap>& tap) override;
  bool live() const override { return true; }
  bool relative() const override;
  double clock_s(double now_s) const override { return now_s; }

protected:
  void collect(double now_s, std::vector<ProbeSample>& samples) override;
  std::string problem() const override { return problem_; }
  std::uint64_t dropped() const override;

private:
  class Reader;
  std::shared_ptr<Reader> reader_;  ///< shared with the thread, which may outlive this object
  std::chrono::milliseconds ending_;
  std::string problem_;
  std::jthread thread_;
};

}  // namespace insonate
