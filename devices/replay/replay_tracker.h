#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// A recorded run, delivered again: the log's own samples to the bit, with the log's own times. The speed decides only
/// when they come. When looping, the times of each further round go on from those of the round before, so that they
/// keep rising; the poses stay the log's.
class ReplayTracker : public Tracker {
public:
  struct Options {
    double speed = 1.0;  ///< > 0; 2 replays in half the time
    bool loop = false;   ///< begin again at the end
  };

  /// `samples` are at least one, with strictly rising times; else throws std::invalid_argument.
  ReplayTracker(std::string name, std::vector<PoseSample> samples, const Options& options,
                std::optional<Recording> recording = std::nullopt);

  const Recording* recording() const override { return recording_ ? &*recording_ : nullptr; }
  bool repeats() const override { return options_.loop; }
  double clock_s(double now_s) const override;

protected:
  void collect(double now_s, std::vector<PoseSample>& samples) override;
  std::optional<double> progress() const override;

private:
  std::vector<PoseSample> log_;
  Options options_;
  std::optional<Recording> recording_;
  double round_s_;                 ///< how long a round takes on the log's clock, with the step back to its beginning
  std::optional<double> start_s_;  ///< of the first poll
  std::size_t next_ = 0;           ///< index into the log
  std::size_t round_ = 0;          ///< how often the log has been through
  double last_time_s_ = 0;
};

/// The speed and loop of a replay's URI, which may have no other options than `allowed`, and which names a file. Throws
/// InputError.
ReplayTracker::Options replay_options(const TrackerUri& uri, std::initializer_list<std::string_view> allowed);

/// replay:FILE[?speed=2&loop=1&transform=ProbeToTracker&rate=25], with speeds from 0.01 to 1000 and rates from 0.01 to
/// 10,000 Hz; for transform and rate see RecordingOptions. Throws InputError.
std::unique_ptr<Tracker> open_replay(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
