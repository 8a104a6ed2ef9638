#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "devices/filter/sample_filters.h"
#include "devices/live/live_source.h"
#include "devices/tracker.h"

namespace insonate {

/// A device read by a thread of its own. Whoever polls never waits for it, and whoever ends it hardly.
///
/// Its clock is steady_now_s(), and that is what it has to be polled with. The thread starts with the first poll, so
/// that a tracker which is only asked for its name opens nothing, and ends with the tracker. A device that does not let
/// go within `ending` is left to its thread, and what is opened next waits for that on a thread of its own: nobody
/// opens a device that is just being closed.
///
/// Once a sample has come, silence is told by samples of its own: when nothing has come for `silence`, whether the
/// device is gone or says nothing, a sample `missing` follows, and others at `heartbeat` for as long as it lasts. So an
/// exam's time goes on without its tracker.
class LiveTracker : public Tracker {
public:
  struct Options {
    /// Samples that wait for the next poll: half a second of eight sensors at 1000 Hz.
    std::size_t capacity = 4096;
    std::chrono::milliseconds read{20};          ///< the longest that a read waits
    std::chrono::milliseconds first_pause{250};  ///< before a source that is gone is opened again; doubles each time
    std::chrono::milliseconds longest_pause{2000};
    std::chrono::milliseconds silence{500};
    std::chrono::milliseconds heartbeat{100};
    std::chrono::milliseconds ending{40};  ///< the longest that ending waits
  };

  LiveTracker(std::unique_ptr<LiveSource> source, const Options& options);
  explicit LiveTracker(std::unique_ptr<LiveSource> source) : LiveTracker(std::move(source), Options()) {}
  ~LiveTracker() override;

  /// What is done to the samples, on the thread, before anybody sees them: nothing until told. To be set before the
  /// first poll.
  void set_filters(const FilterSettings& settings);
  const FilterSettings& filters() const;

  bool record_raw(const std::shared_ptr<RawTap>& tap) override;
  bool live() const override { return true; }
  bool relative() const override;
  double clock_s(double now_s) const override { return now_s; }

protected:
  void collect(double now_s, std::vector<PoseSample>& samples) override;
  std::string problem() const override { return problem_; }
  std::uint64_t dropped() const override;

private:
  class Reader;
  std::shared_ptr<Reader> reader_;  ///< the thread's too, which may outlive this
  std::chrono::milliseconds ending_;
  std::string problem_;
  std::jthread thread_;
};

}  // namespace insonate
