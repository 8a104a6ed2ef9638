#include "app/panels/scan/picture_plates.h"

#include <algorithm>
#include <cstdint>
#include <string>

namespace insonate::ui {

const char* stop_words(Session::Stop stop) {
  switch (stop) {
    case Session::Stop::none:
      return "";
    case Session::Stop::at_edge:
      return "The probe stays on the skin, which ends where the CT ends";
    case Session::Stop::tilted:
      return "Any farther, the handle would lie on the body";
  }
  return "";
}

ImTextureID id_of(const gl::Texture& texture) {
  return reinterpret_cast<ImTextureID>(std::uintptr_t(texture.name()));
}

Rect draw_title(const Theme& theme, const Rect& panel, std::string_view title) {
  const Rect plate{panel.x + theme.px(4), panel.y + theme.px(4),
                   std::min(text_width(theme.small_text, title) + theme.px(12), panel.w - theme.px(8)), theme.px(22)};
  fill(plate, colour::kPlate, theme.px(3));
  draw_text(plate.inset(theme.px(6), 0), theme.small_text, colour::kMuted, title);
  return plate;
}

Rect draw_on_plate(const Theme& theme, const Rect& where, ImFont* font, ImU32 colour, std::string_view text,
                   Align align) {
  const float margin = theme.px(4), width = std::min(text_width(font, text), where.w);
  const float x = align == Align::left    ? where.x
                  : align == Align::right ? where.x + where.w - width
                                          : where.x + (where.w - width) / 2;
  const Rect plate{x - margin, where.y, width + 2 * margin, where.h};
  fill(plate, colour::kPlate, theme.px(3));
  draw_text({x, where.y, width + 1, where.h}, font, colour, text);
  return plate;
}

void draw_edge_letters(const Theme& theme, const Rect& picture, const view::EdgeLetters& letters,
                       const Rect& upper_left, const Rect& lower_left) {
  const float margin = theme.px(4), height = theme.px(20), gap = theme.px(6);
  const auto draw = [&](const std::string& text, float x, float y) {
    const Rect plate{x, y, text_width(theme.small_text, text) + theme.px(8), height};
    fill(plate, colour::kPlate, theme.px(3));
    draw_text(plate, theme.small_text, colour::kText, text, Align::centre);
  };
  const auto width = [&](const std::string& text) { return text_width(theme.small_text, text) + theme.px(8); };
  const auto beside = [&](const std::string& text, const Rect& corner) {
    const float middle = picture.x + (picture.w - width(text)) / 2;
    return corner.w > 0 ? std::max(middle, corner.x + corner.w + gap) : middle;
  };
  const float middle = picture.y + (picture.h - height) / 2;
  draw(letters.left, picture.x + margin, middle);
  draw(letters.right, picture.x + picture.w - margin - width(letters.right), middle);
  draw(letters.top, beside(letters.top, upper_left), picture.y + margin);
  draw(letters.bottom, beside(letters.bottom, lower_left), picture.y + picture.h - margin - height);
}

}  // namespace insonate::ui
