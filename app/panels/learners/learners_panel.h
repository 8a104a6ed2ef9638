#pragma once

#include <functional>
#include <map>
#include <string>

#include "app/panels/learners/attempt_panel.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/learners_page.h"

namespace insonate::ui {

/// What a click on the page of learners asks for.
enum class LearnersAnswer { none, leave, help, review, report, tables };

/// Draws the page of learners: their list on the left, the trend of a scenario and of its criteria in the middle, and
/// on the right the attempts, and the chosen one with its comments.
class LearnersPanel {
public:
  using Run = AttemptPanel::Run;

  /// @param run     runs what may throw; an exception becomes a problem to acknowledge
  /// @param places  receives the positions of what can be clicked, by name
  LearnersAnswer draw(const Theme& theme, const Rect& screen, LearnersPage& page, const Run& run,
                      std::map<std::string, Rect>& places);

  bool types_text() const { return attempt_.types_text(); }
  bool ready() const { return attempt_.ready(); }
  void close_fields(bool keep) { attempt_.close_fields(keep); }

private:
  LearnersAnswer draw_head(const Theme& theme, Rect head, const LearnersPage& page);
  void draw_learners(const Theme& theme, const Rect& panel, LearnersPage& page);
  void draw_scores(const Theme& theme, const Rect& panel, LearnersPage& page);
  void draw_criteria(const Theme& theme, const Rect& panel, const LearnersPage& page);
  void draw_attempts(const Theme& theme, const Rect& panel, LearnersPage& page);
  LearnersAnswer draw_attempt(const Theme& theme, const Rect& panel, LearnersPage& page, const Run& run);

  AttemptPanel attempt_;
  std::string seen_learner_;                       ///< chosen in the last frame
  std::string seen_list_;                          ///< learner, mode and attempt that were chosen in the last frame
  std::map<std::string, Rect>* places_ = nullptr;  ///< of the current draw()
};

}  // namespace insonate::ui
