#pragma once

#include "app/trainer/options.h"

namespace insonate {

/// Runs the session without a window, in simulated time as fast as it goes, and writes to options.out: the
/// ResultFiles when the exam ended, ultrasound.png and trainer.png of the moment when the view was held best (or of the
/// end), and score_sheet.png. Prints the score and the paths. Returns the exit code; throws InputError.
int run_headless(const Options& options);

}  // namespace insonate
