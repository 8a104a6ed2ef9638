#include "devices/live/live_tracker.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <utility>

#include "devices/live/detached_threads.h"
#include "devices/live/raw_source.h"
#include "devices/live/sample_conditioner.h"
#include "devices/live/sample_ring.h"
#include "devices/live/steady_clock.h"

namespace insonate {
namespace {

double seconds(std::chrono::milliseconds duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

/// The thread's function and all its state.
class LiveTracker::Reader {
public:
  Reader(std::unique_ptr<LiveSource> source, const Options& options)
      : options_(options), source_(std::move(source)), ring_(options.capacity) {}

  // Called before the thread starts.
  void set_filters(const FilterSettings& settings) { conditioner_ = SampleConditioner(settings); }
  const FilterSettings& filters() const { return conditioner_.filters(); }
  bool record_raw(const std::shared_ptr<RawTap>& tap) {
    auto* raw = dynamic_cast<RawSource*>(source_.get());
    if (!raw) return false;
    raw->record_raw(tap);
    tap_ = tap;
    return true;
  }

  bool relative() const { return source_->relative(); }

  // Called on the thread.
  void run(const std::stop_token& stop) {
    join_detached_threads(stop);
    auto wait = options_.first_pause;
    while (!stop.stop_requested()) {
      if (open_source()) {
        brought_any_ = false;
        while (!stop.stop_requested() && read_source()) publish_silence();
        source_->close();
        if (brought_any_) wait = options_.first_pause;
      }
      pause(stop, wait);
      wait = std::min(2 * wait, options_.longest_pause);
    }
    const std::lock_guard lock(mutex_);
    ended_ = true;
    end_.notify_all();
  }

  // Called on the polling thread.
  void drain(std::vector<ProbeSample>& samples, std::string& problem) {
    ring_.drain(samples);
    // If the lock is taken now, the previous problem is kept.
    if (const std::unique_lock lock(mutex_, std::try_to_lock); lock) problem = latest_problem_;
  }
  std::uint64_t dropped() const { return ring_.dropped(); }
  bool ends_within(std::chrono::milliseconds how_long) {
    std::unique_lock lock(mutex_);
    return end_.wait_for(lock, how_long, [this] { return ended_; });
  }

private:
  bool open_source() {
    try {
      source_->open();
      return true;
    } catch (const std::exception& error) {
      report(error.what());
      return false;
    }
  }

  bool read_source() {
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
    // Samples that arrived before the source was lost are published.
    for (const ProbeSample& sample : batch_.samples) publish(sample);
    if (!batch_.samples.empty()) {
      heard_s_ = steady_now_s();
      heard_ = brought_any_ = true;
    }
    report(problem);
    return there;
  }

  void publish(ProbeSample sample) {
    conditioner_.apply(sample, source_->origin());
    ring_.push(sample);
  }

  void publish_silence() {
    if (!heard_) return;
    const double now_s = steady_now_s(), last_s = conditioner_.last_time_s();
    if (now_s - heard_s_ < seconds(options_.silence) || now_s - last_s < seconds(options_.heartbeat)) return;
    if (tap_) tap_->silent(now_s);
    publish(silence_at(now_s));
  }

  void report(const std::string& problem) {
    const std::lock_guard lock(mutex_);
    if (latest_problem_ != problem) latest_problem_ = problem;
  }

  void pause(const std::stop_token& stop, std::chrono::milliseconds how_long) {
    std::mutex mutex;
    std::condition_variable_any stopped;
    std::unique_lock lock(mutex);
    const auto end = std::chrono::steady_clock::now() + how_long;
    while (!stop.stop_requested() && std::chrono::steady_clock::now() < end) {
      const auto beat = std::min(end, std::chrono::steady_clock::now() + options_.heartbeat);
      stopped.wait_until(lock, stop, beat, [] { return false; });
      publish_silence();
    }
  }

  const Options options_;
  const std::unique_ptr<LiveSource> source_;
  LiveBatch batch_;
  SampleConditioner conditioner_;
  std::shared_ptr<RawTap> tap_;
  double heard_s_ = 0;        ///< when the source last delivered a sample
  bool heard_ = false;        ///< whether it ever did
  bool brought_any_ = false;  ///< whether it did since it was opened

  // Shared between the threads.
  SampleRing<ProbeSample> ring_;
  std::mutex mutex_;
  std::string latest_problem_;
  bool ended_ = false;
  std::condition_variable end_;
};

LiveTracker::LiveTracker(std::unique_ptr<LiveSource> source, const Options& options)
    : Tracker(source->name()), reader_(std::make_shared<Reader>(std::move(source), options)), ending_(options.ending) {}

LiveTracker::~LiveTracker() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  if (!reader_->ends_within(ending_)) detach_thread(std::move(thread_));
}

void LiveTracker::set_filters(const FilterSettings& settings) {
  reader_->set_filters(settings);
}

const FilterSettings& LiveTracker::filters() const {
  return reader_->filters();
}

bool LiveTracker::record_raw(const std::shared_ptr<RawTap>& tap) {
  return reader_->record_raw(tap);
}

bool LiveTracker::relative() const {
  return reader_->relative();
}

std::uint64_t LiveTracker::dropped() const {
  return reader_->dropped();
}

void LiveTracker::collect(double, std::vector<ProbeSample>& samples) {
  if (!thread_.joinable())
    thread_ = std::jthread([reader = reader_](const std::stop_token& stop) { reader->run(stop); });
  reader_->drain(samples, problem_);
}

}  // namespace insonate
