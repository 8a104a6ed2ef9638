#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// Replays a recorded run: exactly the log's samples, bit for bit, with the log's times. The speed only decides when
/// they come. In a loop, the times of each further pass continue from those of the pass before, so that they keep
/// rising; the poses stay the log's.
class ReplayTracker : public Tracker {
public:
  struct Options {
    double speed = 1.0;  ///< > 0; 2 replays in half the time
    bool loop = false;   ///< restart at the end
  };

  /// Throws std::invalid_argument unless `samples` holds at least one sample, their times rise strictly, and the speed
  /// is above 0.
  ReplayTracker(std::string name, std::vector<ProbeSample> samples, const Options& options,
                std::optional<Recording> recording = std::nullopt);

  const Recording* recording() const override { return recording_ ? &*recording_ : nullptr; }
  bool repeats() const override { return options_.loop; }
  double clock_s(double now_s) const override;

protected:
  void collect(double now_s, std::vector<ProbeSample>& samples) override;
  std::optional<double> progress() const override;

private:
  std::vector<ProbeSample> log_;
  Options options_;
  std::optional<Recording> recording_;
  double round_s_;                 ///< duration of a pass on the log's clock, including the step back to its beginning
  std::optional<double> start_s_;  ///< time of the first poll
  std::size_t next_ = 0;           ///< index into the log
  std::size_t round_ = 0;          ///< number of complete passes
  double last_time_s_ = 0;
};

/// Returns the speed and loop options of a replay's URI. Throws InputError if the URI has options that are not in
/// `allowed`, or names no file.
ReplayTracker::Options replay_options(const TrackerUri& uri, std::initializer_list<std::string_view> allowed);

/// Opens replay:FILE[?speed=2&loop=1&transform=ProbeToTracker&rate=25]. Speeds are 0.01 to 1000, rates 0.01 to 10,000
/// Hz; see RecordingOptions for transform and rate. Throws InputError.
std::unique_ptr<Tracker> open_replay(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
