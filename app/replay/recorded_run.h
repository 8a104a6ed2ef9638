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

/// A run at one of its samples: what a session that plays its log shows from that sample until the next one. Times are
/// in seconds since the first sample.
struct RunMoment {
  double time_s = 0;
  std::optional<Pose> shown_pose;       ///< of the picture, which may be frozen; empty before the first usable sample
  std::optional<Pose> newest_pose;      ///< of the probe
  std::optional<double> last_usable_s;  ///< time of the newest usable sample
  std::size_t machine = 0;              ///< index into RecordedRun::machines
  std::size_t annotations = 0;          ///< index into RecordedRun::annotations
  std::size_t step = 0;                 ///< of the scenario; 0 without a scenario
  bool on_skin = false;                 ///< reported by the runner, as are all fields below; false without a scenario
  bool within_tolerance = false;        ///< whether the picture is within the step's tolerances
  std::optional<ViewValues> view;       ///< compared with the step's view; of a usable sample only
  double speed_mm_s = 0;                ///< of the middle of the face (MotionMeter)
};

/// An action other than moving the probe, in words: "Freeze", "Depth 12.0 cm".
struct RunEvent {
  double time_s = 0;
  bool is_marker = false;  ///< an event marker, set by the probe's mark button or the key
  std::string words;
};

/// An interval of a run that was spent on one step. With free step order a step may have several.
struct RunStretch {
  std::size_t step = 0;
  double start_s = 0, end_s = 0;
};

/// A finished run, stored sample by sample, so that any time of it can be looked up directly. It is not an attempt and
/// cannot become one.
struct RecordedRun {
  std::string name;                           ///< of the log, for the screen
  std::vector<RunMoment> moments;             ///< at least one; times rise from 0
  std::vector<Machine> machines;              ///< each setting of the machine, in order
  std::vector<ShownAnnotations> annotations;  ///< annotations over the picture, in order
  std::vector<RunStretch> stretches;          ///< without gaps from 0 to the end; exactly one without a scenario
  std::vector<RunEvent> events;               ///< in order of time
  std::optional<ExamResult> result;           ///< empty without a scenario
  std::optional<RecordedImages> images;       ///< one per moment, in order; empty if the recording has no images

  double duration_s() const { return moments.back().time_s; }
  /// Returns the index of the moment that applies at `time_s`: the last one that is not later, or the first.
  std::size_t index_at(double time_s) const;
  const RunMoment& at(double time_s) const { return moments[index_at(time_s)]; }
  const Machine& machine_at(double time_s) const { return machines[at(time_s).machine]; }
  const ShownAnnotations& annotations_at(double time_s) const { return annotations[at(time_s).annotations]; }
  /// Returns the index of the stretch that contains `time_s`; a boundary belongs to the later stretch.
  std::size_t stretch_at(double time_s) const;
  /// Returns the time since the last usable pose (s) once it exceeds Session::kStale_s, as Session::lost_for_s() does;
  /// empty before.
  std::optional<double> lost_for_s(double time_s) const;
};

/// Plays a log through its own session, sample by sample. Does not keep `loaded_case` afterwards.
/// @param progress  receives the completed share, 0 to 1
/// Throws what Session throws if the scenario does not fit the case or the log's actions cannot be read.
RecordedRun play_through(const std::shared_ptr<const LoadedCase>& loaded_case, const RecordedScan& scan,
                         const std::function<void(double share)>& progress = {});

}  // namespace insonate
