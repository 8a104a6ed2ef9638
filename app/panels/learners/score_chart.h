#pragma once

#include <cstdint>
#include <optional>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/learners_page.h"

namespace insonate::ui {

/// Draws the scores of attempts at one scenario over the attempts' number: a mark per attempt, whose shape is its mode,
/// the pass mark, and of a group the median between its quartiles. Returns the attempt that was clicked; 0 for none.
/// @param chosen  attempt to be marked; 0 for none
/// @param group   the attempts are of several learners, so that no line joins them
std::int64_t draw_score_chart(const Theme& theme, Rect where, const ScoreTrend& trend, std::int64_t chosen, bool group);

}  // namespace insonate::ui
