#include "devices/calibration/steps/finding_step.h"

namespace insonate {

void FindingStep::mark(double time_s) {
  if (done_) return;
  refusal_.clear();
  marked(time_s);
}

void FindingStep::undo() {
  refusal_.clear();
  taken_back(std::exchange(done_, false));
}

SetupView FindingStep::view() const {
  SetupView view;
  view.title = title_;
  view.refusal = refusal_;
  view.part = part();
  view.done = done_;
  if (done_) {
    view.share = 1;
    view.result = result();
  } else {
    ask(view);
  }
  return view;
}

}  // namespace insonate
