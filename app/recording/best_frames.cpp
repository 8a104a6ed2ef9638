#include "app/recording/best_frames.h"

#include <optional>

#include "app/recording/results.h"

namespace insonate {

bool BestFrames::due(const Session& session) const {
  if (!session.runner()) return false;
  constexpr double kStep = 0.1;  // of the hold
  const LiveExam& live = session.runner()->live();
  if (session.attempt() != attempt_ || live.step != step_) return live.hold_share > 0;
  return live.hold_share > share_ + kStep;
}

void BestFrames::keep(const Session& session, const Pictures& pictures) {
  if (!pictures.ultrasound()) return;
  const LiveExam& live = session.runner()->live();
  forget_older(session);
  step_ = live.step;
  share_ = live.hold_share;
  frames_[live.step] = mirrored(read_back(*pictures.ultrasound()));
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
