#pragma once

#include <filesystem>

#include "app/panels/screen.h"
#include "app/trainer/trainer.h"

namespace insonate {

/// Writes the trainer's state as a flat JSON object, one key per line. Tests that drive the window from outside and
/// displays beside it read this file. Rectangles of panels are in pixels from the window's top left.
/// @param frames   laid out so far
/// @param shown    those of them that changed the screen
/// @param quality  of the next frame, from the QualityGovernor
void write_state(const std::filesystem::path& file, Trainer& trainer, const ui::Screen& screen, long frames, long shown,
                 double quality);

}  // namespace insonate
