#include "devices/tracker.h"

#include <algorithm>

namespace insonate {

std::string_view to_string(TrackerCondition condition) {
  switch (condition) {
    case TrackerCondition::waiting:
      return "waiting";
    case TrackerCondition::tracking:
      return "tracking";
    case TrackerCondition::lost:
      return "lost";
    case TrackerCondition::finished:
      return "finished";
  }
  return "waiting";
}

void Tracker::poll(double now_s, std::vector<ProbeSample>& samples) {
  if (!(now_s >= now_s_)) return;
  now_s_ = now_s;
  const std::size_t before = samples.size();
  collect(now_s, samples);
  for (std::size_t i = before; i < samples.size(); ++i) {
    const ProbeSample& sample = samples[i];
    if (delivered_ == 0) last_usable_s_ = sample.time_s;
    recent_times_s_[delivered_ % recent_times_s_.size()] = sample.time_s;
    ++delivered_;
    last_status_ = sample.status;
    if (sample.distortion) distortion_ = sample.distortion;
    if (sample.rejected != Rejection::none) {
      rejected_ = sample.rejected;
      rejected_s_ = sample.time_s;
    }
    if (sample.status != PoseStatus::ok) continue;
    ++usable_;
    last_usable_s_ = sample.time_s;
  }
}

TrackerState Tracker::state() const {
  TrackerState state;
  state.name = name_;
  state.last_status = last_status_;
  state.distortion = distortion_;
  if (rejected_ != Rejection::none && clock_s(now_s_) - rejected_s_ <= kShowRejection_s) state.rejected = rejected_;
  state.delivered = delivered_;
  state.usable = usable_;
  state.progress = progress();
  state.problem = problem();
  state.dropped = dropped();

  const std::uint64_t kept = std::min<std::uint64_t>(delivered_, recent_times_s_.size());
  if (kept >= 2) {
    const double newest = recent_times_s_[(delivered_ - 1) % recent_times_s_.size()];
    const double oldest = recent_times_s_[(delivered_ - kept) % recent_times_s_.size()];
    state.rate_hz = double(kept - 1) / (newest - oldest);
  }

  if (state.progress && *state.progress >= 1)
    state.condition = TrackerCondition::finished;
  else if (delivered_ == 0)
    state.condition = TrackerCondition::waiting;
  else if (clock_s(now_s_) - last_usable_s_ > kLostAfter_s)
    state.condition = TrackerCondition::lost;
  else
    state.condition = TrackerCondition::tracking;
  return state;
}

}  // namespace insonate
