#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/learners_page.h"

namespace insonate::ui {

/// Draws a line per criterion, those that lose most points first: what it judges, a bar per attempt with the share of
/// its points that was earned, and the points that an attempt loses by it.
void draw_criteria_list(const Theme& theme, Rect where, const ScoreTrend& trend);

}  // namespace insonate::ui
