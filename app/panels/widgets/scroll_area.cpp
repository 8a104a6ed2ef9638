#include "app/panels/widgets/scroll_area.h"

#include <algorithm>

namespace insonate::ui {

ScrollArea::ScrollArea(const Theme& theme, const char* id, const Rect& where, float height) : where_(where) {
  const float bar = theme.px(14);
  ImGui::SetCursorScreenPos(where.min());
  ImGui::PushStyleVar(ImGuiStyleVar_ScrollbarSize, bar);
  ImGui::PushStyleColor(ImGuiCol_ChildBg, 0);
  ImGui::BeginChild(id, {where.w, where.h});
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  ImGui::Dummy({1, height});  // gives the content its height
  content_ = {origin.x, origin.y, where.w - (height > where.h ? bar : 0), height};
}

ScrollArea::~ScrollArea() {
  ImGui::EndChild();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

void ScrollArea::bring_into_view(const Rect& part) const {
  if (part.y < where_.y)
    ImGui::SetScrollY(part.y - content_.y);
  else if (part.y + part.h > where_.y + where_.h)
    ImGui::SetScrollY(part.y + part.h - content_.y - where_.h);
}

}  // namespace insonate::ui
