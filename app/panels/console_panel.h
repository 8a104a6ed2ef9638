#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/session.h"

namespace insonate::ui {

/// What the console's buttons ask for beyond the session itself.
enum class ConsoleRequest { none, help, open };

/// The machine's knobs, and the buttons of the session.
ConsoleRequest draw_console_panel(const Theme& theme, const Rect& panel, Session& session,
                                  const std::function<void(const std::function<void()>&)>& attempt);

}  // namespace insonate::ui
