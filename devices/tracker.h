#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/recording.h"
#include "sim/core/probe_sample.h"

namespace insonate {

class MouseTracker;
class RawTap;
class RehearsalTracker;

enum class TrackerCondition {
  waiting,   ///< open, but no sample has come yet
  tracking,  ///< usable samples arrive
  lost,      ///< no usable sample for kLostAfter_s
  finished,  ///< a log has been replayed to its end: no more samples follow
};

std::string_view to_string(TrackerCondition condition);

/// A tracker counts as lost after this long without a usable sample.
inline constexpr double kLostAfter_s = 1.0;

/// TrackerState reports the reason of a rejection for this long, so that a person can read it.
inline constexpr double kShowRejection_s = 0.5;

/// State of a tracker, as the screen shows it.
struct TrackerState {
  std::string name;  ///< in words: "replay of good_scan.igs.mha at twice the speed"
  TrackerCondition condition = TrackerCondition::waiting;
  double rate_hz = 0;  ///< over the last samples, on the tracker's clock; 0 until there are two
  PoseStatus last_status = PoseStatus::unknown;  ///< status of the newest sample
  std::uint64_t delivered = 0;                   ///< samples returned since the tracker was opened
  std::uint64_t usable = 0;                      ///< those whose status is ok
  std::optional<double> progress;                ///< from 0 to 1, for a tracker that has an end
  std::optional<std::uint32_t> distortion;       ///< the tracker's latest distortion grade; empty if it reports none
  Rejection rejected = Rejection::none;  ///< why the newest rejected sample was rejected, for kShowRejection_s after it
  std::string problem;        ///< what is wrong with the device now and what to do, as a sentence; empty if nothing is
  std::uint64_t dropped = 0;  ///< samples lost because poll() was not called in time
};

/// A source of probe poses: a device, a log, or a synthetic hand.
///
/// The owner of the tracker polls it, once per frame or at any other rate. poll() returns every sample exactly once, in
/// order, with strictly rising times. The rate of polling only decides how the samples are grouped. Time is an
/// argument, so that a run can be paused, replayed and tested. A device with its own thread passes its samples through
/// a bounded queue that collect() empties, so poll() never waits. Not thread-safe: one thread polls.
class Tracker {
public:
  virtual ~Tracker() = default;
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  /// Appends the samples that have arrived up to `now_s` (s, any steady clock, but steady_now_s() for a live tracker).
  /// The first call starts the tracker. A call with an earlier time than the last one appends nothing.
  void poll(double now_s, std::vector<ProbeSample>& samples);

  TrackerState state() const;

  /// Returns the recorded scan that the samples come from, or nullptr if there is none.
  virtual const Recording* recording() const { return nullptr; }

  /// Returns whether earlier samples come again, as from a log that restarts at its end.
  virtual bool repeats() const { return false; }

  /// Returns whether samples arrive in real time, as from a device: a caller cannot run ahead, and samples that were
  /// not polled in time are lost.
  virtual bool live() const { return false; }

  /// Returns whether the samples report how the probe rotates or moves but not its absolute position, as from a sensor
  /// that measures orientation alone. Such a probe can be placed anywhere and continues from there.
  virtual bool relative() const { return false; }

  /// Returns the tracker as one that the program itself moves, for the learner's mouse and keyboard; nullptr for all
  /// others.
  virtual MouseTracker* steered() { return nullptr; }

  /// Returns the tracker as one whose made-up hand follows the set-up; nullptr for all others.
  virtual RehearsalTracker* rehearsed() { return nullptr; }

  /// Passes everything that the device sends to `tap` from the first poll on, before it is parsed; raw_recorder.h
  /// records it. A null `tap` receives nothing. Call it before the first poll. Returns false, and does nothing, if
  /// there is no device.
  virtual bool record_raw(const std::shared_ptr<RawTap>&) { return false; }

  /// Returns the time of the tracker's own clock, which stamps its samples, at `now_s`. Use it to query a PoseHistory.
  /// Meaningful after the first poll.
  virtual double clock_s(double now_s) const = 0;

protected:
  explicit Tracker(std::string name) : name_(std::move(name)) {}

  /// Appends what has arrived since the last call. `now_s` never decreases from call to call.
  virtual void collect(double now_s, std::vector<ProbeSample>& samples) = 0;

  /// Returns how much of all samples has been returned, from 0 to 1; 1 means finished. Empty if the tracker has no end.
  virtual std::optional<double> progress() const { return std::nullopt; }

  /// The next two fill in TrackerState.
  virtual std::string problem() const { return {}; }
  virtual std::uint64_t dropped() const { return 0; }

private:
  std::string name_;
  double now_s_ = -std::numeric_limits<double>::infinity();
  std::array<double, 32> recent_times_s_{};  ///< times of the newest samples, as a ring indexed by delivered_
  std::uint64_t delivered_ = 0;
  std::uint64_t usable_ = 0;
  double last_usable_s_ = 0;  ///< on the tracker's clock; time of the first sample until a usable one comes
  PoseStatus last_status_ = PoseStatus::unknown;
  std::optional<std::uint32_t> distortion_;
  Rejection rejected_ = Rejection::none;
  double rejected_s_ = 0;  ///< on the tracker's clock
};

}  // namespace insonate
