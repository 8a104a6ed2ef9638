#include "app/replay/replay.h"

#include <algorithm>
#include <utility>

namespace insonate {
namespace {

/// The place of one run's time in the other run: as far into the same step, counted from when the other run first came
/// to that step.
struct Place {
  const RunStretch* in = nullptr;  ///< of the other run; null if it never came to the step
  double time_s = 0;               ///< may lie after the stretch's end
};

Place place_in(const RecordedRun& other, const RecordedRun& run, double time_s) {
  const RunStretch& here = run.stretches[run.stretch_at(time_s)];
  const auto there = std::find_if(other.stretches.begin(), other.stretches.end(),
                                  [&](const RunStretch& stretch) { return stretch.step == here.step; });
  if (there == other.stretches.end()) return {};
  return {&*there, there->start_s + (time_s - here.start_s)};
}

}  // namespace

std::optional<double> Replay::expert_time_s(double time_s) const {
  if (!expert_) return std::nullopt;
  const Place place = place_in(*expert_, run_, time_s);
  return place.in ? std::optional(std::min(place.time_s, place.in->end_s)) : std::nullopt;
}

std::optional<double> Replay::beside_s(double expert_s) const {
  if (!expert_) return std::nullopt;
  const Place place = place_in(run_, *expert_, expert_s);
  return place.in && place.time_s <= place.in->end_s ? std::optional(place.time_s) : std::nullopt;
}

void Replay::seek(double time_s) {
  time_s_ = std::clamp(time_s, 0.0, run_.duration_s());
}

void Replay::step(int samples) {
  playing_ = false;
  const long last = long(run_.moments.size()) - 1;
  time_s_ = run_.moments[std::size_t(std::clamp(long(run_.index_at(time_s_)) + samples, 0L, last))].time_s;
}

void Replay::toggle() {
  playing_ = !playing_;
  if (playing_ && time_s_ >= run_.duration_s()) time_s_ = 0;
}

void Replay::change_speed(int by) {
  speed_ = std::size_t(std::clamp(int(speed_) + by, 0, int(kSpeeds.size()) - 1));
}

void Replay::advance(double now_s) {
  const double since_s = now_s - std::exchange(last_now_s_, now_s).value_or(now_s);
  if (!playing_ || since_s <= 0) return;
  seek(time_s_ + since_s * speed());
  if (time_s_ >= run_.duration_s()) playing_ = false;
}

}  // namespace insonate
