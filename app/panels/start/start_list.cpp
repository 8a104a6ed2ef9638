#include "app/panels/start/start_list.h"

#include <algorithm>
#include <utility>

namespace insonate::ui {

std::optional<std::size_t> draw_list(const Theme& theme, const char* id, const Rect& where,
                                     const std::vector<ListRow>& rows, std::optional<std::size_t> chosen,
                                     std::map<std::string, Rect>& places) {
  const float height = theme.px(kListRow), bar = theme.px(14);
  fill(where, colour::kBackground, theme.px(4));
  ImGui::SetCursorScreenPos(where.min());
  ImGui::PushStyleVar(ImGuiStyleVar_ScrollbarSize, bar);
  ImGui::PushStyleColor(ImGuiCol_ChildBg, 0);
  ImGui::BeginChild(id, {where.w, where.h});
  int& shown = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("chosen"), -1);
  if (chosen && std::exchange(shown, int(*chosen)) != int(*chosen)) {
    const float top = height * float(*chosen);
    ImGui::SetScrollY(std::clamp(ImGui::GetScrollY(), top + height - where.h, std::max(top, top + height - where.h)));
  }
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  const float total = height * float(rows.size());
  const float width = where.w - (total > where.h ? bar : 0);
  std::optional<std::size_t> clicked;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Rect row{origin.x, origin.y + height * float(i), width, height};
    if (row.y + row.h < where.y || row.y > where.y + where.h) continue;
    if (row.y >= where.y && row.y + row.h <= where.y + where.h) places[rows[i].id] = row;
    ImGui::SetCursorScreenPos(row.min());
    ImGui::PushID(int(i));
    if (ImGui::InvisibleButton("row", {row.w, row.h})) clicked = i;
    ImGui::PopID();
    if (chosen == i)
      fill(row, colour::kAccentDark, theme.px(4));
    else if (ImGui::IsItemHovered())
      fill(row, colour::kRaised, theme.px(4));
    Rect line = row.inset(theme.px(12), 0);
    // What the title leaves, but at least half of the row.
    const float left = line.w - theme.px(12) - text_width(theme.text, rows[i].title) - 2;
    const float about = std::min(text_width(theme.small_text, rows[i].about), std::max(left, line.w * 0.5f));
    draw_text(line.take_right(about + 1), theme.small_text, chosen == i ? colour::kText : colour::kMuted, rows[i].about,
              Align::right);
    line.take_right(theme.px(12));
    draw_text(line, theme.text, colour::kText, rows[i].title);
  }
  ImGui::SetCursorScreenPos(origin);
  ImGui::Dummy({1, total});
  ImGui::EndChild();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  return clicked;
}

}  // namespace insonate::ui
