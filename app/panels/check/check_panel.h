#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/check_page.h"

namespace insonate::ui {

enum class CheckAnswer { none, leave, help, open, practise };

/// Draws a scenario's text on the left and its problems on the right, where a click shows the line.
class CheckPanel {
public:
  /// @param places  receives the positions of what can be clicked, by name
  CheckAnswer draw(const Theme& theme, const Rect& screen, CheckPage& page, std::map<std::string, Rect>& places);

private:
  CheckAnswer draw_head(const Theme& theme, Rect head, const CheckPage& page);
  void draw_text_of(const Theme& theme, const Rect& panel, const CheckPage& page);
  void draw_problems(const Theme& theme, Rect panel, CheckPage& page);

  std::optional<std::size_t> shown_;               ///< problem whose line was brought into view last
  std::map<std::string, Rect>* places_ = nullptr;  ///< of the current draw()
};

}  // namespace insonate::ui
