#include "app/panels/widgets/toast.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace insonate::ui {

void Toast::show(std::string text, std::filesystem::path file) {
  text_ = std::move(text);
  file_ = std::move(file);
  until_s_ = ImGui::GetTime() + kShown_s;
}

double Toast::left_s() const {
  return text_.empty() ? 0 : std::max(0.0, until_s_ - ImGui::GetTime());
}

std::filesystem::path Toast::draw(const Theme& theme, const Rect& where, std::map<std::string, Rect>& places) {
  places.erase("show_folder");
  if (left_s() <= 0) text_.clear();
  if (text_.empty()) return {};
  const float margin = theme.px(16), gap = theme.px(12), beside = file_.empty() ? 0 : theme.px(120) + gap;
  const float widest = where.w - 2 * margin - beside;
  const float width = std::min(text_width(theme.strong, text_), widest);
  const float text_height = paragraph_height(theme.strong, text_, width + 1);
  const float height = std::max(text_height, beside > 0 ? theme.px(30) : 0) + theme.px(20);
  const Rect plate{std::round(where.x + (where.w - width - beside) / 2 - margin),
                   std::round(where.y + where.h - height), std::ceil(width + beside + 2 * margin), std::ceil(height)};
  ImGui::SetNextWindowPos(plate.min());
  ImGui::SetNextWindowSize({plate.w, plate.h});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, 0);
  ImGui::Begin("toast", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PopStyleColor();
  ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
  fill(plate, colour::kPanel, theme.px(6));
  outline(plate, colour::kAccent, theme.px(6));
  Rect content = plate.inset(margin, theme.px(10));
  bool asked = false;
  if (!file_.empty()) {
    Rect button_place = content.take_right(theme.px(120));
    button_place = {button_place.x, button_place.centre().y - theme.px(15), button_place.w, theme.px(30)};
    places["show_folder"] = button_place;
    asked = button(theme, "show_folder", button_place, is_page(file_) ? "Open report" : "Show folder");
  }
  content.y += (content.h - text_height) / 2;
  content.w = width + 1;
  draw_paragraph(content, theme.strong, colour::kText, text_);
  ImGui::End();
  if (!asked) return {};
  until_s_ = 0;
  return file_;
}

}  // namespace insonate::ui
