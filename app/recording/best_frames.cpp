#include "app/recording/best_frames.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "app/recording/annotated_picture.h"
#include "app/recording/results.h"

namespace insonate {
namespace {

/// Returns what the step asked for and the learner has placed in the frozen picture.
std::vector<Action> placed_in(const std::optional<Pose>& picture, const PictureTools& tools) {
  std::vector<Action> placed;
  if (!picture || tools.free_choice()) return placed;
  const auto add = [&](const Annotation& annotation) {
    if (annotation.patient_from_probe == *picture) placed.push_back(annotation.action);
  };
  for (const auto& [slot, annotation] : tools.annotations().measured()) add(annotation);
  if (tools.annotations().point()) add(*tools.annotations().point());
  for (const auto& [name, annotation] : tools.annotations().labels()) add(annotation);
  return placed;
}

}  // namespace

// Returns the frames one below the other, with a gap.
Image<Rgba8> BestFrames::stacked(const std::vector<Kept>& kept) {
  constexpr int kGap = 12;
  constexpr Rgba8 kBetween{255, 255, 255, 255};  // as the report's paper
  int width = 0, height = -kGap;
  for (const Kept& one : kept) {
    width = std::max(width, one.frame.width);
    height += one.frame.height + kGap;
  }
  Image<Rgba8> all(width, height, kBetween);
  int top = 0;
  for (const Kept& one : kept) {
    for (int y = 0; y < one.frame.height; ++y)
      for (int x = 0; x < one.frame.width; ++x) all.at(x, top + y) = one.frame.at(x, y);
    top += one.frame.height + kGap;
  }
  return all;
}

void BestFrames::Kept::show(std::vector<Action> in_it) {
  placed = std::move(in_it);
  frame = undrawn;
  draw_annotations(frame, geometry, placed);
}

// The pictures of this step that are kept; null if there are none.
const std::vector<BestFrames::Kept>* BestFrames::kept_of(const Session& session) const {
  const auto of_step = frames_.find(session.runner()->live().step);
  return session.attempt() != attempt_ || of_step == frames_.end() ? nullptr : &of_step->second;
}

void BestFrames::see(const Session& session) {
  forget_older(session);
  if (!session.runner()) return;
  const LiveExam& live = session.runner()->live();
  const StepTask* task = session.runner()->scenario().steps[live.step].task.get();
  if (!live.finished && live.view && task && task->holds_view() && session.shown_pose())
    last_seen_.insert_or_assign(live.step, Seen{*session.shown_pose(), session.machine()});
}

bool BestFrames::due(const Session& session, const PictureTools& tools) const {
  if (!session.runner()) return false;
  constexpr double kStep = 0.1;  // of the hold
  const LiveExam& live = session.runner()->live();
  const std::vector<Kept>* kept = kept_of(session);
  const bool is_worked_in = kept && !kept->front().placed.empty();
  if (!live.finished && !tools.free_choice()) {
    // Work in one picture may replace, take back or clear what was placed in another.
    const auto is_old = [&](const Kept& one) { return one.placed != placed_in(one.picture, tools); };
    if (kept && std::ranges::any_of(*kept, is_old)) return true;
    const std::optional<Pose> picture = session.frozen_picture();
    if (!placed_in(picture, tools).empty() && (!kept || std::ranges::count(*kept, picture, &Kept::picture) == 0))
      return true;
  }
  if (session.attempt() != attempt_ || live.step != step_) return live.hold_share > 0;
  return !is_worked_in && live.hold_share > share_ + kStep;
}

void BestFrames::keep(const Session& session, const PictureTools& tools, const Pictures& pictures) {
  if (!pictures.ultrasound()) return;
  const LiveExam& live = session.runner()->live();
  forget_older(session);
  std::vector<Kept>& kept = frames_[live.step];
  for (Kept& one : kept) one.show(placed_in(one.picture, tools));
  const std::optional<Pose> picture = session.frozen_picture();
  std::vector<Action> placed = placed_in(picture, tools);
  // A picture in which nothing is placed stands for the step as long as there is no other.
  const bool is_better = live.step != step_ || live.hold_share > share_;
  const bool stands_alone = std::ranges::all_of(kept, [](const Kept& one) { return one.placed.empty(); });
  const bool is_new = std::ranges::count(kept, picture, &Kept::picture) == 0;
  if (kept.empty() || (placed.empty() ? stands_alone && is_better : is_new)) {
    Kept now{mirrored(read_back(*pictures.ultrasound())), {}, pictures.geometry(), picture, {}};
    now.show(std::move(placed));
    kept.push_back(std::move(now));
  }
  const bool any_placed = std::ranges::any_of(kept, [](const Kept& one) { return !one.placed.empty(); });
  if (any_placed)
    std::erase_if(kept, [](const Kept& one) { return one.placed.empty(); });
  else
    kept.erase(kept.begin(), kept.end() - 1);
  step_ = live.step;
  share_ = live.hold_share;
}

void BestFrames::forget_older(const Session& session) {
  if (attempt_ == session.attempt()) return;
  *this = {};
  attempt_ = session.attempt();
}

std::vector<ReportPicture> BestFrames::report_pictures(const Session& session, Pictures& pictures) const {
  const std::vector<StepResult>& steps = session.result()->steps;
  std::vector<ReportPicture> shown;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto kept = frames_.find(i);
    const auto seen = last_seen_.find(i);
    // The values of a view that was not held are those of its last moments.
    const bool by_last_pose = seen != last_seen_.end() && steps[i].outcome != StepOutcome::held &&
                              (kept == frames_.end() || kept->second.front().placed.empty());
    if (const auto last = by_last_pose ? pictures.still(seen->second.pose, seen->second.machine) : std::nullopt)
      shown.push_back(report_picture(i, ReportPicture::Kind::best, mirrored(*last)));
    else if (kept != frames_.end())
      shown.push_back(report_picture(i, ReportPicture::Kind::best, stacked(kept->second)));
    const ReferenceView* view = session.loaded_case().subject.find_view(steps[i].view);
    if (const auto picture = view ? pictures.reference_picture(*view) : std::nullopt)
      shown.push_back(report_picture(i, ReportPicture::Kind::reference, mirrored(*picture)));
  }
  return shown;
}

}  // namespace insonate
