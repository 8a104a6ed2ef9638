#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "devices/live/hand_over.h"
#include "devices/live/live_source.h"
#include "devices/live/raw_source.h"
#include "devices/live/sample_ring.h"
#include "devices/tracker.h"

namespace insonate {

/// A device read by a thread of its own. Whoever polls never waits for it.
///
/// Its clock is steady_now_s(), and that is what it has to be polled with. The thread starts with the first poll, so
/// that a tracker which is only asked for its name opens nothing, and ends with the tracker.
///
/// Once a sample has come, silence is told by samples of its own: when nothing has come for `silence`, whether the
/// device is gone or says nothing, a sample `missing` follows, and others at `heartbeat` for as long as it lasts. So an
/// exam's time goes on without its tracker.
class LiveTracker : public Tracker {
public:
  struct Options {
    /// Samples that wait for the next poll: half a second of eight sensors at 1000 Hz.
    std::size_t capacity = 4096;
    std::chrono::milliseconds read{20};  ///< the longest that a read waits, and so about the longest that ending takes
    std::chrono::milliseconds first_pause{250};  ///< before a source that is gone is opened again; doubles each time
    std::chrono::milliseconds longest_pause{2000};
    std::chrono::milliseconds silence{500};
    std::chrono::milliseconds heartbeat{100};
  };

  LiveTracker(std::unique_ptr<LiveSource> source, const Options& options);
  explicit LiveTracker(std::unique_ptr<LiveSource> source) : LiveTracker(std::move(source), Options()) {}
  ~LiveTracker() override;

  /// What is done to the samples, on the thread, before anybody sees them: nothing until told. To be set before the
  /// first poll.
  void set_filters(const FilterSettings& settings) { hand_over_ = HandOver(settings); }
  const FilterSettings& filters() const { return hand_over_.filters(); }

  bool record_raw(const std::shared_ptr<RawTap>& tap) override;
  bool live() const override { return true; }
  double clock_s(double now_s) const override { return now_s; }

protected:
  void collect(double now_s, std::vector<PoseSample>& samples) override;
  std::string problem() const override { return problem_; }
  std::uint64_t dropped() const override { return ring_.dropped(); }

private:
  // On the thread
  void run(const std::stop_token& stop);
  bool open_source();
  bool read_source();
  void hand_over(PoseSample sample);
  void tell_silence();
  void tell(const std::string& problem);
  void pause(const std::stop_token& stop, std::chrono::milliseconds how_long);

  Options options_;
  std::unique_ptr<LiveSource> source_;
  LiveBatch batch_;
  HandOver hand_over_;
  std::shared_ptr<RawTap> tap_;
  double heard_s_ = 0;        ///< when the source last brought a sample
  bool heard_ = false;        ///< whether it ever did
  bool brought_any_ = false;  ///< whether it did since it was opened

  // Between the threads
  SampleRing<PoseSample> ring_;
  std::mutex told_mutex_;  ///< collect() only tries it: who cannot have it keeps what it knew
  std::string told_;

  // On the polling thread
  std::string problem_;
  std::jthread thread_;
};

}  // namespace insonate
