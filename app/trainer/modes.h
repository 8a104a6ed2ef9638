#pragma once

#include <concepts>
#include <memory>
#include <variant>

#include "app/recording/best_frames.h"
#include "app/recording/exam_journal.h"
#include "app/replay/replay.h"
#include "app/session/author.h"
#include "app/session/picture_tools.h"
#include "app/session/session.h"
#include "app/session/step_controls.h"
#include "app/session/undo_history.h"
#include "app/trainer/check_page.h"
#include "app/trainer/learners_page.h"
#include "app/trainer/setup_wizard.h"
#include "app/trainer/start_page.h"

namespace insonate {

// What the trainer is doing: one of these at a time. ARCHITECTURE.md draws how they follow each other.

/// Nothing is shown: what the command line names is still being loaded, or the exam that it asked for is refused.
struct Idle {};

/// The person chooses what to do.
struct Choosing {
  std::unique_ptr<StartPage> page;  ///< never null
};

/// An instructor looks at the learners and their attempts.
struct Overseeing {
  std::unique_ptr<LearnersPage> page;  ///< never null
};

/// An author writes a scenario in an editor, and sees what is wrong with it.
struct Checking {
  std::unique_ptr<CheckPage> page;  ///< never null
};

/// A probe on a patient: what practice, exams and authoring have in common.
struct Scan {
  std::unique_ptr<Session> session;  ///< never null
  PictureTools tools;
  StepControls controls;
  UndoHistory undo;
  BestFrames best_frames;
  bool begun = true;    ///< false while the learner reads the briefing: no time passes
  double now_s = 0;     ///< the trainer's time at the last update
  double behind_s = 0;  ///< for how long the session's time has stood still since its beginning
};

/// Practice, also of an exam's steps: nothing counts, and nothing is stored while it lasts.
struct Practice : Scan {};

/// An exam that counts: it is stored from its first sample on.
struct Exam : Scan {
  std::unique_ptr<ExamJournal> journal;  ///< once it has begun, where there is a database
};

/// Reference views of a case are being made.
struct Authoring : Scan {
  Author author;
};

/// A run that is over is played again. Nothing is scored or stored.
struct Playback {
  std::unique_ptr<Replay> replay;  ///< never null
};

/// The tracker is being set up. It belongs to the wizard, so there is no session.
struct SettingUp {
  std::unique_ptr<SetupWizard> wizard;  ///< never null
};

using TrainerMode = std::variant<Idle, Choosing, Overseeing, Checking, Practice, Exam, Authoring, Playback, SettingUp>;

/// Returns what practice, exams and authoring have in common; nullptr in another mode.
inline Scan* scan_of(TrainerMode& mode) {
  return std::visit(
      []<typename M>(M& of) -> Scan* {
        if constexpr (std::derived_from<M, Scan>) return &of;
        return nullptr;
      },
      mode);
}

}  // namespace insonate
