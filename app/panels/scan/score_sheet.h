#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "scenarios/result.h"
#include "scenarios/results/export/report_files.h"

namespace insonate::ui {

enum class ScoreAnswer { none, again, own_try, practice, open_report, leave, close };

/// Draws the score of a finished exam: verdict, each criterion's value, limits, points and reason, and where the report
/// is.
/// @param writing  whether the report is still to be written
/// @param watched  whether a recorded scan was scored instead of the learner's own hand
/// @param once     whether another attempt and practice are ruled out
/// @param learner  whose score it is; empty for nobody in particular
/// @param places   receives the rectangle of the learner's id
ScoreAnswer draw_score_sheet(const Theme& theme, const Rect& screen, const ExamResult& result,
                             const std::optional<ResultFiles>& files, bool writing, bool watched, bool once,
                             const std::string& learner, std::map<std::string, Rect>& places);

}  // namespace insonate::ui
