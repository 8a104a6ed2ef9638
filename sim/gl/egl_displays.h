#pragma once

#include <functional>
#include <vector>

namespace insonate::gl {

/// What an EGL context without a window may be made on.
struct EglDisplay {
  std::function<void*()> open;  ///< gives the display, not yet initialised, or EGL_NO_DISPLAY
  bool is_software;             ///< is known to be; others may turn out to be
};

/// All of them, best first.
///
/// Graphics cards in EGL's order, then Mesa's surfaceless platform, which takes a card of its own choice or none, then
/// software renderers. With LIBGL_ALWAYS_SOFTWARE, which drivers other than Mesa's do not know, no cards.
/// INSONATE_EGL_DEVICE=n, counted from 0, leaves that one of EGL's devices alone; throws InputError when there is none.
std::vector<EglDisplay> egl_displays();

}  // namespace insonate::gl
