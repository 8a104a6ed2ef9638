#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/recording.h"
#include "sim/core/pose_sample.h"

namespace insonate {

class RawTap;

enum class TrackerCondition {
  waiting,   ///< open, but no sample has come yet
  tracking,  ///< usable samples come
  lost,      ///< no usable sample for kLostAfterS
  finished,  ///< a log has been replayed to its end: nothing more will come
};

std::string_view to_string(TrackerCondition condition);

/// After so long without a usable sample a tracker counts as lost.
inline constexpr double kLostAfterS = 1.0;

/// For so long it is told why a sample was rejected, so that a person can read it.
inline constexpr double kToldRejectedS = 0.5;

/// What the screen shows of a tracker.
struct TrackerState {
  std::string name;  ///< in words: "replay of good_scan.igs.mha at twice the speed"
  TrackerCondition condition = TrackerCondition::waiting;
  double rate_hz = 0;                            ///< over the last samples, on the tracker's clock; 0 until two came
  PoseStatus last_status = PoseStatus::unknown;  ///< of the newest sample
  std::uint64_t delivered = 0;                   ///< samples handed over since the tracker was opened
  std::uint64_t usable = 0;                      ///< those of them whose status is ok
  std::optional<double> progress;                ///< from 0 to 1, for a tracker that has an end
  std::optional<std::uint32_t> distortion;       ///< as the tracker last graded it; empty of one that does not
  Rejection rejected = Rejection::none;  ///< why the newest sample was that was rejected in the last kToldRejectedS
  std::string problem;        ///< what is wrong with the device now and what to do, as a sentence; empty for nothing
  std::uint64_t dropped = 0;  ///< samples lost because nobody polled in time
};

/// A source of probe poses: a device, a log, a made-up hand.
///
/// Whoever owns the tracker polls it, once a frame or as it likes. Every sample comes out exactly once, in order, with
/// times that strictly rise; how often and when poll() is called decides only in which portions they come. Time is
/// passed in, so that a run can be paused, replayed and tested. A device with a thread of its own hands its samples
/// over through a bounded queue that collect() empties: poll() never waits. Not thread-safe: one thread polls.
class Tracker {
public:
  virtual ~Tracker() = default;
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  /// Appends the samples that have come up to `now_s` (s, any steady clock, but steady_now_s() for a live tracker; the
  /// first call starts the tracker). A time before that of the last call brings nothing.
  void poll(double now_s, std::vector<PoseSample>& samples);

  TrackerState state() const;

  /// The recorded scan whose samples come, if there is one.
  virtual const Recording* recording() const { return nullptr; }

  /// Whether samples come again that have come before, as of a log that begins anew at its end.
  virtual bool repeats() const { return false; }

  /// Whether samples come in real time, as of a device: nobody can run ahead of it, and what was not polled is past.
  virtual bool live() const { return false; }

  /// Whether the samples tell how the probe turns or moves but not where it is, as of a sensor that knows its
  /// orientation alone: then it may be put anywhere, and goes on from there.
  virtual bool relative() const { return false; }

  /// Tells `tap` from the first poll on what comes from the device, before it is parsed (raw_recorder.h writes it
  /// down); null for nobody. To be called before the first poll. False, and nothing is told, when there is no device.
  virtual bool record_raw(const std::shared_ptr<RawTap>&) { return false; }

  /// The tracker's own clock, which stamps its samples, at `now_s`: the time to ask a PoseHistory for. Meaningful from
  /// the first poll on.
  virtual double clock_s(double now_s) const = 0;

protected:
  explicit Tracker(std::string name) : name_(std::move(name)) {}

  /// Appends what has come since the last call. `now_s` never runs backwards from call to call.
  virtual void collect(double now_s, std::vector<PoseSample>& samples) = 0;

  /// How much of what will ever come has come, from 0 to 1; 1 means finished. Empty where there is no end.
  virtual std::optional<double> progress() const { return std::nullopt; }

  /// For TrackerState.
  virtual std::string problem() const { return {}; }
  virtual std::uint64_t dropped() const { return 0; }

private:
  std::string name_;
  double now_s_ = -std::numeric_limits<double>::infinity();
  std::array<double, 32> recent_times_s_{};  ///< of the newest samples, as a ring indexed by delivered_
  std::uint64_t delivered_ = 0;
  std::uint64_t usable_ = 0;
  double last_usable_s_ = 0;  ///< on the tracker's clock; its start until a usable sample comes
  PoseStatus last_status_ = PoseStatus::unknown;
  std::optional<std::uint32_t> distortion_;
  Rejection rejected_ = Rejection::none;
  double rejected_s_ = 0;  ///< on the tracker's clock
};

}  // namespace insonate
