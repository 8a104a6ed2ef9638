#include "app/replay/recorded_run.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "devices/replay/replay_tracker.h"
#include "scenarios/metrics/motion_meter.h"
#include "scenarios/words.h"
#include "sim/core/text.h"
#include "sim/model/effects.h"

namespace insonate {
namespace {

std::string in_words(const Action& action) {
  switch (action.kind) {
    case ActionKind::probe: {
      const Probe* probe = find_probe(action.text);
      return "Probe " + (probe ? probe->title : action.text);
    }
    case ActionKind::depth:
      return formatted("Depth %.1f cm", action.numbers[0] / 10);
    case ActionKind::frequency:
      return formatted("Frequency %.1f MHz", action.numbers[0]);
    case ActionKind::gain:
      return formatted("Gain %+.0f dB", action.numbers[0]);
    case ActionKind::dynamic_range:
      return formatted("Dynamic range %.0f dB", action.numbers[0]);
    case ActionKind::time_gain:
      return formatted("Time gain %d: %+.0f dB", action.slot(), action.numbers[1]);
    case ActionKind::compounding:
      return action.numbers[0] > 1 ? formatted("Compounding of %.0f angles", action.numbers[0])
                                   : std::string("Compounding off");
    case ActionKind::persistence:
      return formatted("Persistence %.0f %%", 100 * action.numbers[0]);
    case ActionKind::edge_enhancement:
      return formatted("Edge enhancement %.1f", action.numbers[0]);
    case ActionKind::speckle_reduction:
      return formatted("Speckle reduction %.0f %%", 100 * action.numbers[0]);
    case ActionKind::effect: {
      const Effect* effect = find_effect(action.text);
      if (!effect) return "Effects as usual";
      const std::string name = insonate::in_words(std::string(effect->name));
      return "Effect " + name +
             (effect->is_switch() ? action.numbers[0] != 0 ? " on" : " off" : formatted(" %.3g", action.numbers[0]));
    }
    case ActionKind::freeze:
      return "Freeze";
    case ActionKind::unfreeze:
      return "Live";
    case ActionKind::caliper:
      return formatted("Caliper %d", action.slot());
    case ActionKind::ellipse:
      return formatted("Ellipse %d", action.slot());
    case ActionKind::point:
      return "Point";
    case ActionKind::label:
      return "Label '" + action.text + "'";
    case ActionKind::take_back:
      return action.slot() > 0
                 ? formatted("Took %d back", action.slot())
                 : "Took " + (action.text.empty() ? std::string("the point") : "'" + action.text + "'") + " back";
    case ActionKind::answer:
      return "Answer '" + action.text + "'";
    case ActionKind::hint:
      return "Hint";
    case ActionKind::go_to:
      return "Turned to '" + action.text + "'";
    case ActionKind::go_on:
      return "Went on";
    case ActionKind::patient:
      return "";
    case ActionKind::guide:
      return action.numbers[0] != 0 ? "Guide on" : "Guide off";
  }
  return "";
}

/// Records what the session shows after a sample.
class Recorder {
public:
  Recorder(RecordedRun& run, double first_s) : run_(run), first_s_(first_s) {}

  void see(const Session& session, const ProbeSample& sample) {
    RunMoment moment;
    moment.time_s = sample.time_s - first_s_;
    moment.shown_pose = session.shown_pose();
    moment.newest_pose = session.newest_pose();
    if (sample.status == PoseStatus::ok) last_usable_s_ = moment.time_s;
    moment.last_usable_s = last_usable_s_;
    moment.machine = index_of(run_.machines, session.machine());
    tools_.see(session);
    moment.annotations = index_of(run_.annotations, shown_annotations(session, tools_));
    if (const Runner* runner = session.runner()) {
      const LiveExam& live = runner->live();
      moment.step = live.step;
      if (!live.finished) {
        moment.on_skin = live.on_skin;
        moment.within_tolerance = live.within_tolerance;
        moment.view = live.view;
      } else if (!std::exchange(finished_, true) && sample.status == PoseStatus::ok && !run_.moments.empty()) {
        // A sample that ends the exam by its time is not measured itself.
        const RunMoment& before = run_.moments.back();
        moment.on_skin = before.on_skin;
        moment.within_tolerance = before.within_tolerance;
        moment.view = before.view;
      }
    }
    ProbeSample timed = sample;
    timed.time_s = moment.time_s;
    motion_.feed(timed, moment.on_skin);
    moment.speed_mm_s = motion_.speed_mm_s();
    if (run_.stretches.empty() || run_.stretches.back().step != moment.step) {
      if (!run_.stretches.empty()) run_.stretches.back().end_s = moment.time_s;
      run_.stretches.push_back({moment.step, moment.time_s, moment.time_s});
    }
    run_.stretches.back().end_s = moment.time_s;
    run_.moments.push_back(moment);
  }

private:
  /// Stores only values that differ from the previous one.
  template <typename Value>
  static std::size_t index_of(std::vector<Value>& values, const Value& value) {
    if (values.empty() || !(values.back() == value)) values.push_back(value);
    return values.size() - 1;
  }

  RecordedRun& run_;
  double first_s_;
  std::optional<double> last_usable_s_;
  bool finished_ = false;
  MotionMeter motion_;
  PictureTools tools_;  ///< tracks the annotations as the screen's tools would; no learner uses it
};

std::vector<RunEvent> events_of(const RecordedScan& scan, const std::vector<double>& event_markers_s) {
  std::vector<RunEvent> events;
  const double first_s = scan.samples.front().time_s;
  for (const auto& [time_s, actions] : parse_action_log(scan.recording.actions, scan.recording.file))
    for (const Action& action : actions)
      if (action.kind != ActionKind::patient) events.push_back({time_s - first_s, false, in_words(action)});
  for (std::size_t i = 0; i < event_markers_s.size(); ++i)
    events.push_back({event_markers_s[i], true, "Mark " + std::to_string(i + 1)});
  std::stable_sort(events.begin(), events.end(),
                   [](const RunEvent& a, const RunEvent& b) { return a.time_s < b.time_s; });
  return events;
}

}  // namespace

std::size_t RecordedRun::index_at(double time_s) const {
  const auto later = std::upper_bound(moments.begin(), moments.end(), time_s,
                                      [](double t, const RunMoment& moment) { return t < moment.time_s; });
  return later == moments.begin() ? 0 : std::size_t(std::distance(moments.begin(), later)) - 1;
}

std::size_t RecordedRun::stretch_at(double time_s) const {
  std::size_t found = 0;
  while (found + 1 < stretches.size() && stretches[found + 1].start_s <= time_s) ++found;
  return found;
}

std::optional<double> RecordedRun::lost_for_s(double time_s) const {
  const RunMoment& moment = at(time_s);
  if (&moment == &moments.back()) return std::nullopt;  // the recording is over: no more poses are expected
  const double lost_s = time_s - moment.last_usable_s.value_or(0);
  return lost_s > Session::kStale_s ? std::optional(lost_s) : std::nullopt;
}

RecordedRun play_through(const std::shared_ptr<const LoadedCase>& loaded_case, const RecordedScan& scan,
                         const std::function<void(double share)>& progress) {
  RecordedRun run;
  run.name = scan.recording.file;
  Session session(loaded_case, [&] {
    return std::make_unique<ReplayTracker>("replay of " + run.name, scan.samples, ReplayTracker::Options{},
                                           scan.recording);
  });
  Recorder recorder(run, scan.samples.front().time_s);
  for (std::size_t i = 0; i < scan.samples.size(); ++i) {
    // The tracker's clock starts with the first poll. One advance() per sample gives each a poll of its own.
    session.advance(scan.samples[i].time_s - scan.samples.front().time_s);
    recorder.see(session, scan.samples[i]);
    if (progress && i % 64 == 0) progress(double(i) / double(scan.samples.size()));
  }
  run.events = events_of(scan, session.event_markers_s());
  run.result = session.result();
  run.images = scan.images;
  return run;
}

}  // namespace insonate
