#include "devices/live/live_tracker.h"

#include <algorithm>
#include <condition_variable>
#include <utility>

#include "devices/live/steady_clock.h"

namespace insonate {
namespace {

double seconds(std::chrono::milliseconds duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

LiveTracker::LiveTracker(std::unique_ptr<LiveSource> source, const Options& options)
    : Tracker(source->name()), options_(options), source_(std::move(source)), ring_(options.capacity) {}

LiveTracker::~LiveTracker() = default;  // the thread, last of the members, is stopped and joined first

bool LiveTracker::record_raw(const std::shared_ptr<RawTap>& tap) {
  auto* raw = dynamic_cast<RawSource*>(source_.get());
  if (!raw) return false;
  raw->record_raw(tap);
  tap_ = tap;
  return true;
}

void LiveTracker::collect(double, std::vector<PoseSample>& samples) {
  if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  ring_.drain(samples);
  if (const std::unique_lock lock(told_mutex_, std::try_to_lock); lock) problem_ = told_;
}

void LiveTracker::run(const std::stop_token& stop) {
  auto wait = options_.first_pause;
  while (!stop.stop_requested()) {
    if (open_source()) {
      brought_any_ = false;
      while (!stop.stop_requested() && read_source()) tell_silence();
      source_->close();
      if (brought_any_) wait = options_.first_pause;
    }
    pause(stop, wait);
    wait = std::min(2 * wait, options_.longest_pause);
  }
}

bool LiveTracker::open_source() {
  try {
    source_->open();
    return true;
  } catch (const std::exception& error) {
    tell(error.what());
    return false;
  }
}

bool LiveTracker::read_source() {
  batch_.samples.clear();
  batch_.note.clear();
  std::string problem;
  bool there = true;
  try {
    source_->read(options_.read, batch_);
    problem = batch_.note;
  } catch (const std::exception& error) {
    problem = error.what();
    there = false;
  }
  // What came before the source was lost counts.
  for (const PoseSample& sample : batch_.samples) hand_over(sample);
  if (!batch_.samples.empty()) {
    heard_s_ = steady_now_s();
    heard_ = brought_any_ = true;
  }
  tell(problem);
  return there;
}

void LiveTracker::hand_over(PoseSample sample) {
  hand_over_.apply(sample, source_->origin());
  ring_.push(sample);
}

void LiveTracker::tell_silence() {
  if (!heard_) return;
  const double now_s = steady_now_s();
  const double last_s = hand_over_.last_time_s();
  if (now_s - heard_s_ < seconds(options_.silence) || now_s - last_s < seconds(options_.heartbeat)) return;
  if (tap_) tap_->silent(now_s);
  hand_over(silence_at(now_s));
}

void LiveTracker::tell(const std::string& problem) {
  const std::lock_guard lock(told_mutex_);
  if (told_ != problem) told_ = problem;
}

void LiveTracker::pause(const std::stop_token& stop, std::chrono::milliseconds how_long) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  const auto end = std::chrono::steady_clock::now() + how_long;
  while (!stop.stop_requested() && std::chrono::steady_clock::now() < end) {
    const auto beat = std::min(end, std::chrono::steady_clock::now() + options_.heartbeat);
    stopped.wait_until(lock, stop, beat, [] { return false; });
    tell_silence();
  }
}

}  // namespace insonate
