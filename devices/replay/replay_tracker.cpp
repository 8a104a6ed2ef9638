#include "devices/replay/replay_tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "devices/sequence/probe_samples.h"
#include "sim/core/input_error.h"

namespace insonate {

ReplayTracker::ReplayTracker(std::string name, std::vector<ProbeSample> samples, const Options& options,
                             std::optional<Recording> recording)
    : Tracker(std::move(name)), log_(std::move(samples)), options_(options), recording_(std::move(recording)) {
  if (log_.empty()) throw std::invalid_argument("a log without samples cannot be replayed");
  if (!(options_.speed > 0)) throw std::invalid_argument("the replay's speed is not above 0");
  for (std::size_t i = 1; i < log_.size(); ++i)
    if (!(log_[i].time_s > log_[i - 1].time_s)) throw std::invalid_argument("the log's times do not rise");
  // The step from the last sample to the first of the next pass is the average step. A log of one sample repeats every
  // second.
  const double duration = log_.back().time_s - log_.front().time_s;
  round_s_ = log_.size() > 1 ? duration + duration / double(log_.size() - 1) : 1.0;
}

double ReplayTracker::clock_s(double now_s) const {
  return log_.front().time_s + (start_s_ ? (now_s - *start_s_) * options_.speed : 0.0);
}

void ReplayTracker::collect(double now_s, std::vector<ProbeSample>& samples) {
  if (!start_s_) start_s_ = now_s;
  const double elapsed_s = (now_s - *start_s_) * options_.speed;
  for (;;) {
    if (next_ == log_.size()) {
      if (!options_.loop) return;
      next_ = 0;
      ++round_;
    }
    const double due_s = log_[next_].time_s - log_.front().time_s + double(round_) * round_s_;
    if (due_s > elapsed_s) return;
    ProbeSample sample = log_[next_++];
    if (round_ > 0) {
      sample.time_s += double(round_) * round_s_;
      // Steps smaller than the resolution of a double must not vanish in the sum.
      sample.time_s = std::max(sample.time_s, std::nextafter(last_time_s_, HUGE_VAL));
    }
    last_time_s_ = sample.time_s;
    samples.push_back(sample);
  }
}

std::optional<double> ReplayTracker::progress() const {
  if (options_.loop) return std::nullopt;
  return double(next_) / double(log_.size());
}

ReplayTracker::Options replay_options(const TrackerUri& uri, std::initializer_list<std::string_view> allowed) {
  uri.allow_options(allowed);
  if (uri.subject.empty())
    throw InputError("tracker '" + uri.text + "'", "", "it names no file",
                     "write it as in '" + uri.scheme + ":" + (uri.scheme == "raw" ? "scan.raw'" : "scan.igs.mha'"));
  return {uri.number("speed", 1.0, 0.01, 1000.0), uri.flag("loop", false)};
}

std::unique_ptr<Tracker> open_replay(const TrackerUri& uri, const TrackerContext&) {
  const ReplayTracker::Options options = replay_options(uri, {"speed", "loop", "transform", "rate"});
  RecordingOptions recording;
  if (const auto transform = uri.options.find("transform"); transform != uri.options.end())
    recording.transform = transform->second;
  recording.rate_hz = uri.number("rate", 0, 0.01, 10000);
  RecordedScan scan = read_recorded_scan(uri.subject, recording);
  return std::make_unique<ReplayTracker>("replay of " + scan.recording.file, std::move(scan.samples), options,
                                         scan.recording);
}

}  // namespace insonate
