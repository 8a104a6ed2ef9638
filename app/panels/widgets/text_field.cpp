#include "app/panels/widgets/text_field.h"

#include <utility>

namespace insonate::ui {

std::string TextField::draw(const Theme& theme, const Rect& given, const std::string& text, const char* hint,
                            const std::string& unit) {
  Rect where = given;
  if (!unit.empty()) {
    const float width = text_width(theme.text, unit);
    draw_text(where.take_right(width), theme.text, colour::kMuted, unit);
    where.take_right(theme.px(8));
  }
  fill(where, colour::kRaised, theme.px(4));
  outline(where, open_ ? colour::kAccent : colour::kLine, theme.px(4));
  const float margin = theme.px(10);
  if (!open_) {
    filled_ = false;
    ImGui::SetCursorScreenPos(where.min());
    open_ = ImGui::InvisibleButton("text_field", {where.w, where.h});
    draw_text(where.inset(margin, 0), theme.text, text.empty() ? colour::kFaint : colour::kText,
              text.empty() ? hint : text);
    return text;
  }
  if (!std::exchange(filled_, true)) typed_[text.copy(typed_.data(), typed_.size() - 1)] = 0;
  ImGui::SetCursorScreenPos({where.x, where.y + (where.h - theme.text->FontSize) / 2 - theme.px(4)});
  ImGui::PushFont(theme.text);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {margin, theme.px(4)});
  ImGui::PushStyleColor(ImGuiCol_FrameBg, 0);
  ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, 0);
  ImGui::PushStyleColor(ImGuiCol_FrameBgActive, 0);
  ImGui::SetNextItemWidth(where.w);
  if (!ready_) ImGui::SetKeyboardFocusHere();
  ImGui::InputText("##text", typed_.data(), typed_.size(), ImGuiInputTextFlags_AutoSelectAll);
  const bool active = ImGui::IsItemActive();
  ImGui::PopStyleColor(3);
  ImGui::PopStyleVar();
  ImGui::PopFont();
  if (ready_ && !active) close();  // the user clicked elsewhere
  ready_ = open_ && (ready_ || active);
  return typed_.data();
}

}  // namespace insonate::ui
