#pragma once

#include <array>
#include <optional>

#include "app/replay/recorded_run.h"

namespace insonate {

/// A run that is looked at again: a time that can be moved at will, by hand or by a clock that is passed in, and beside
/// it an expert's run at the same place of the same step. What it shows at a time depends on the time alone, however it
/// was come to.
class Replay {
public:
  /// The speeds there are, in times the run's own.
  static constexpr std::array kSpeeds{0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

  explicit Replay(RecordedRun run, std::optional<RecordedRun> expert = std::nullopt)
      : run_(std::move(run)), expert_(std::move(expert)) {}

  const RecordedRun& run() const { return run_; }
  /// Null without one.
  const RecordedRun* expert() const { return expert_ ? &*expert_ : nullptr; }

  /// s since the first sample, 0 to the run's duration.
  double time_s() const { return time_s_; }
  const RunMoment& moment() const { return run_.at(time_s_); }
  const Machine& machine() const { return run_.machine_at(time_s_); }
  const ShownAnnotations& annotations() const { return run_.annotations_at(time_s_); }

  /// The time of the expert's run that lies as far behind the beginning of its step, or its end once the expert had
  /// gone on; empty without an expert, and where the expert never came to that step.
  std::optional<double> expert_time_s() const { return expert_time_s(time_s_); }
  std::optional<double> expert_time_s(double time_s) const;
  /// Where a time of the expert's run lies on this run's time line, aligned the same way; empty where this run had gone
  /// on by then.
  std::optional<double> beside_s(double expert_s) const;

  void seek(double time_s);
  /// By so many samples, backward too; stops playing.
  void step(int samples);

  bool playing() const { return playing_; }
  /// Plays or pauses; at the end it plays from the beginning.
  void toggle();
  void pause() { playing_ = false; }
  double speed() const { return kSpeeds[speed_]; }
  /// To the next faster (+1) or slower (-1) speed, as far as there is one.
  void change_speed(int by);

  /// Moves on with a steady clock while it plays, and pauses at the end.
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
