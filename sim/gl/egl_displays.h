#pragma once

#include <functional>
#include <vector>

namespace insonate::gl {

/// A display on which an EGL context without a window can be created.
struct EglDisplay {
  std::function<void*()> open;  ///< returns the display, not yet initialised, or EGL_NO_DISPLAY
  bool is_software;             ///< true where this is known; other displays may turn out to be software
};

/// Returns all displays, best first.
///
/// Graphics cards come in EGL's order. Mesa's surfaceless platform follows, which chooses a card itself or takes none.
/// Software renderers come last. LIBGL_ALWAYS_SOFTWARE removes the cards; drivers other than Mesa's ignore it.
/// INSONATE_EGL_DEVICE=n, counted from 0, leaves only that EGL device. Throws InputError if it does not exist.
std::vector<EglDisplay> egl_displays();

}  // namespace insonate::gl
