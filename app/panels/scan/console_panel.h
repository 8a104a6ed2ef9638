#pragma once

#include <functional>
#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/session.h"

namespace insonate::ui {

/// Requests of the console's buttons that go beyond the session.
enum class ConsoleRequest { none, help, open, brief, switch_holder, practise };

/// Returns the height that a console of that width needs: more if the text is too large for names and values of the
/// knobs to stand beside each other.
float console_height(const Theme& theme, float width);

/// Draws the machine's controls and the buttons of the session. A control that cannot be used now is dim, and says why
/// to the pointer. Passes actions that may throw to `attempt`.
/// @param places  receives the rectangles of the probes' buttons, and of the one that begins steps or leaves them
ConsoleRequest draw_console_panel(const Theme& theme, const Rect& panel, Session& session,
                                  const std::function<void(const std::function<void()>&)>& attempt,
                                  std::map<std::string, Rect>& places);

}  // namespace insonate::ui
