#include "app/recording/best_frames.h"

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

bool BestFrames::due(const Session& session, const PictureTools& tools) const {
  if (!session.runner()) return false;
  constexpr double kStep = 0.1;  // of the hold
  const LiveExam& live = session.runner()->live();
  if (session.attempt() != attempt_ || live.step != step_) return live.hold_share > 0;
  if (live.hold_share > share_ + kStep) return true;
  const std::optional<Pose> picture = session.frozen_picture();
  if (!picture || live.finished || tools.free_choice()) return false;
  const std::vector<Action> placed = placed_in(picture, tools);
  // What is taken back leaves the kept picture; another picture replaces it once something is placed there.
  return placed != placed_ && (picture == picture_ || !placed.empty());
}

void BestFrames::keep(const Session& session, const PictureTools& tools, const Pictures& pictures) {
  if (!pictures.ultrasound()) return;
  const LiveExam& live = session.runner()->live();
  forget_older(session);
  step_ = live.step;
  share_ = live.hold_share;
  Image<Rgba8> frame = mirrored(read_back(*pictures.ultrasound()));
  picture_ = session.frozen_picture();
  placed_ = placed_in(picture_, tools);
  draw_annotations(frame, pictures.geometry(), placed_);
  frames_[live.step] = std::move(frame);
}

void BestFrames::forget_older(const Session& session) {
  if (attempt_ == session.attempt()) return;
  *this = {};
  attempt_ = session.attempt();
}

std::vector<ReportPicture> BestFrames::report_pictures(const Session& session, Pictures& pictures) const {
  std::vector<ReportPicture> shown;
  for (const auto& [step, frame] : frames_) shown.push_back(report_picture(step, ReportPicture::Kind::best, frame));
  const std::vector<StepResult>& steps = session.result()->steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const ReferenceView* view = session.loaded_case().subject.find_view(steps[i].view);
    if (const auto picture = view ? pictures.reference_picture(*view) : std::nullopt)
      shown.push_back(report_picture(i, ReportPicture::Kind::reference, mirrored(*picture)));
  }
  return shown;
}

}  // namespace insonate
