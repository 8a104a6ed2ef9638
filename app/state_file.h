#pragma once

#include <filesystem>

#include "app/panels/screen.h"
#include "app/trainer/trainer.h"

namespace insonate {

/// Writes what the trainer is doing as a flat JSON object, one key a line: for tests that drive the window from
/// outside and for displays beside it. Rectangles of panels are pixels from the window's top left.
/// @param quality  that the next frame is drawn with (QualityGovernor)
void write_state(const std::filesystem::path& file, Trainer& trainer, const ui::Screen& screen, long frames,
                 double quality);

}  // namespace insonate
