#pragma once

#include "app/trainer/options.h"

namespace insonate {

/// Runs the session without a window, in simulated time and as fast as possible (in real time with a live tracker or an
/// OpenIGTLink server). Writes to options.out: the ResultFiles if the exam ended, score_sheet.png, and ultrasound.png
/// and trainer.png of the moment when the view was held best (or of the end). Prints the score and the paths. Returns
/// the exit code. Throws InputError.
int run_headless(const Options& options);

}  // namespace insonate
