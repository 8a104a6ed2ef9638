#pragma once

#include <optional>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "scenarios/result.h"
#include "scenarios/results/report_files.h"

namespace insonate::ui {

enum class ScoreAnswer { none, again, own_try, practice, open_report, close };

/// The marks of a finished exam: verdict, each criterion's value, limits, points and why, and where the report is.
/// @param watched  whether a recorded scan was scored, and not the learner's own hand
/// @param once     there is neither another attempt nor practice
ScoreAnswer draw_score_sheet(const Theme& theme, const Rect& screen, const ExamResult& result,
                             const std::optional<ResultFiles>& files, bool watched, bool once);

}  // namespace insonate::ui
