#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/panels/start/task_details.h"
#include "app/panels/widgets/text_field.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/start_page.h"

namespace insonate::ui {

/// Draws the start page: what there is to do on the left, the details of the chosen task in the middle, and on the
/// right who is learning, with which tracker, and what has been done before.
class StartPanel {
public:
  /// @param attempt  runs what may throw; an exception becomes a problem to acknowledge
  /// @param places   receives the positions of what can be clicked, by name
  StartAnswer draw(const Theme& theme, const Rect& screen, StartPage& page,
                   const std::function<void(const std::function<void()>&)>& attempt,
                   std::map<std::string, Rect>& places);

  bool types_text() const { return learner_.is_open() || address_.is_open(); }
  bool ready() const { return learner_.ready() || address_.ready(); }
  /// Closes the open field and takes what was typed, or with `keep` false forgets it.
  void close_fields(bool keep);

private:
  using Attempt = std::function<void(const std::function<void()>&)>;
  void draw_learner(const Theme& theme, Rect panel, StartPage& page, const Attempt& attempt);
  void draw_trackers(const Theme& theme, Rect panel, StartPage& page, const Attempt& attempt);
  void draw_attempts(const Theme& theme, Rect panel, StartPage& page);

  TextField learner_, address_;
  std::string typed_learner_, typed_address_;
  bool learner_was_open_ = false, address_was_open_ = false;
  std::map<std::string, Rect>* places_ = nullptr;  ///< of the current draw()
};

}  // namespace insonate::ui
