#pragma once

#include "app/trainer/options.h"

namespace insonate {

/// Returns whether a window can be opened here at all. Keeps the connection to the display for run_window.
bool has_display();

/// Runs the trainer in a window until it is closed or options.seconds have passed. Returns the exit code. Throws
/// std::runtime_error if no window with OpenGL 4.5 can be created.
int run_window(const Options& options);

}  // namespace insonate
