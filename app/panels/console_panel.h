#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/session.h"

namespace insonate::ui {

/// Requests of the console's buttons that go beyond the session.
enum class ConsoleRequest { none, help, open };

/// Draws the machine's controls and the buttons of the session. Passes actions that may throw to `attempt`.
ConsoleRequest draw_console_panel(const Theme& theme, const Rect& panel, Session& session,
                                  const std::function<void(const std::function<void()>&)>& attempt);

}  // namespace insonate::ui
