#pragma once

#include <array>
#include <optional>

#include "app/replay/recorded_run.h"

namespace insonate {

/// Replays a finished run: its time can be set freely, by hand or by a clock that is passed in. An optional expert's
/// run is shown beside it, aligned to the same step. The picture at a time depends on that time alone, not on how it
/// was reached.
class Replay {
public:
  /// Available speeds, in multiples of the run's own.
  static constexpr std::array kSpeeds{0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

  explicit Replay(RecordedRun run, std::optional<RecordedRun> expert = std::nullopt)
      : run_(std::move(run)), expert_(std::move(expert)) {}

  const RecordedRun& run() const { return run_; }
  /// Null without an expert.
  const RecordedRun* expert() const { return expert_ ? &*expert_ : nullptr; }

  /// Current time in s since the first sample, 0 to the run's duration.
  double time_s() const { return time_s_; }
  const RunMoment& moment() const { return run_.at(time_s_); }
  const Machine& machine() const { return run_.machine_at(time_s_); }
  const ShownAnnotations& annotations() const { return run_.annotations_at(time_s_); }

  /// Returns the expert's time that is as long after the beginning of the same step, limited to the end of the expert's
  /// step. Empty without an expert, and if the expert never came to that step.
  std::optional<double> expert_time_s() const { return expert_time_s(time_s_); }
  std::optional<double> expert_time_s(double time_s) const;
  /// Returns where a time of the expert's run lies on this run's time line, aligned the same way. Empty if this run had
  /// left the step by then or never came to it.
  std::optional<double> beside_s(double expert_s) const;

  /// Sets the time (s), limited to the run's duration.
  void seek(double time_s);
  /// Moves by a number of samples, backward if negative, and stops playing.
  void step(int samples);

  bool playing() const { return playing_; }
  /// Plays or pauses. At the end it plays from the beginning.
  void toggle();
  void pause() { playing_ = false; }
  double speed() const { return kSpeeds[speed_]; }
  /// Changes to the next faster (+1) or slower (-1) speed, if there is one.
  void change_speed(int by);

  /// Advances with a monotonic clock (s) while it plays, and pauses at the end.
  void advance(double now_s);

private:
  RecordedRun run_;
  std::optional<RecordedRun> expert_;
  double time_s_ = 0;
  bool playing_ = false;
  std::size_t speed_ = 2;
  std::optional<double> last_now_s_;
};

}  // namespace insonate
