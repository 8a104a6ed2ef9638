#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/replay/shown_annotations.h"
#include "app/session/loaded_case.h"
#include "app/session/session.h"
#include "devices/sequence/probe_samples.h"
#include "scenarios/metrics/view_meter.h"
#include "scenarios/result.h"
#include "sim/core/pose.h"

namespace insonate {

/// A run at one of its samples: what a session that plays its log shows from that sample on, until the next one comes.
/// Times are seconds since the first sample.
struct RunMoment {
  double time_s = 0;
  std::optional<Pose> shown_pose;       ///< of the picture, which may be frozen; empty before the first usable sample
  std::optional<Pose> newest_pose;      ///< of the probe
  std::optional<double> last_usable_s;  ///< when the newest usable sample came
  std::size_t machine = 0;              ///< index into RecordedRun::machines
  std::size_t annotations = 0;          ///< index into RecordedRun::annotations
  std::size_t step = 0;                 ///< of the scenario; 0 without one
  bool on_skin = false;                 ///< of the runner, as all below: false without a scenario
  bool within_tolerance = false;        ///< the picture is as the step asks for
  std::optional<ViewValues> view;       ///< against the step's view, of a usable sample
  double speed_mm_s = 0;                ///< of the middle of the face (MotionMeter)
};

/// Something that was done at a moment besides moving the probe, in words: "Freeze", "Depth 12.0 cm".
struct RunEvent {
  double time_s = 0;
  bool mark = false;  ///< the mark button of the probe or the key
  std::string words;
};

/// A stretch of a run that was spent on one step. Where the order is free a step may have several.
struct RunStretch {
  std::size_t step = 0;
  double start_s = 0, end_s = 0;
};

/// All that can be seen of a run that is over, kept sample by sample, so that any time of it can be looked up at once.
/// It is neither an attempt nor the makings of one.
struct RecordedRun {
  std::string name;                           ///< of the log, for the screen
  std::vector<RunMoment> moments;             ///< at least one; times rise from 0
  std::vector<Machine> machines;              ///< each setting of the machine, in their order
  std::vector<ShownAnnotations> annotations;  ///< what lay over the picture, in its order
  std::vector<RunStretch> stretches;          ///< without gaps from 0 to the end; one without a scenario
  std::vector<RunEvent> events;               ///< in the order of time
  std::optional<ExamResult> result;           ///< empty without a scenario
  std::optional<RecordedImages> images;       ///< of the moments, in their order; empty where the recording has none

  double duration_s() const { return moments.back().time_s; }
  /// The moment that holds at a time: the last one that is not later, or the first.
  std::size_t index_at(double time_s) const;
  const RunMoment& at(double time_s) const { return moments[index_at(time_s)]; }
  const Machine& machine_at(double time_s) const { return machines[at(time_s).machine]; }
  const ShownAnnotations& annotations_at(double time_s) const { return annotations[at(time_s).annotations]; }
  /// Index of the stretch that a time lies in; a boundary belongs to the later one.
  std::size_t stretch_at(double time_s) const;
  /// How long no usable pose had come by then, once that is longer than Session::kStale_s; as Session::lost_for_s().
  std::optional<double> lost_for_s(double time_s) const;
};

/// Plays a log through a session of its own, sample by sample. The loaded_case is kept no longer than that.
/// @param progress  the share that is done, 0 to 1
/// Throws what Session throws, when the scenario does not fit the case or the log's actions cannot be read.
RecordedRun play_through(const std::shared_ptr<const LoadedCase>& loaded_case, const RecordedScan& scan,
                         const std::function<void(double share)>& progress = {});

}  // namespace insonate
