#include "app/panels/widgets/toast.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace insonate::ui {

void Toast::show(std::string text) {
  text_ = std::move(text);
  until_s_ = ImGui::GetTime() + kShown_s;
}

double Toast::left_s() const {
  return text_.empty() ? 0 : std::max(0.0, until_s_ - ImGui::GetTime());
}

void Toast::draw(const Theme& theme, const Rect& where) {
  if (left_s() <= 0) text_.clear();
  if (text_.empty()) return;
  const float margin = theme.px(16), widest = where.w - 2 * margin;
  const float width = std::min(text_width(theme.strong, text_), widest);
  const float height = paragraph_height(theme.strong, text_, width + 1) + theme.px(20);
  const Rect plate{std::round(where.x + (where.w - width) / 2 - margin), std::round(where.y + where.h - height),
                   width + 2 * margin, height};
  ImDrawList* list = ImGui::GetForegroundDrawList();
  list->AddRectFilled(plate.min(), plate.max(), colour::kRaised, theme.px(6));
  list->AddRect(plate.min(), plate.max(), colour::kAccent, theme.px(6));
  const Rect text = plate.inset(margin, theme.px(10));
  list->AddText(theme.strong, theme.strong->FontSize, text.min(), colour::kText, text_.data(),
                text_.data() + text_.size(), width + 1);
}

}  // namespace insonate::ui
