#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"

namespace insonate::ui {

/// The pages that have a help of their own.
enum class HelpTopic { start, learners, check, scan, exam, replay, setup, author, score, volume, open, settings };

enum class HelpAnswer { none, close, about, settings };

/// Draws what a page is for, and what keys and mouse do on it.
/// @param places  receives the buttons' rectangles
HelpAnswer draw_help(const Theme& theme, const Rect& screen, HelpTopic topic, std::map<std::string, Rect>& places);

}  // namespace insonate::ui
