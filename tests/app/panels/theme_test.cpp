// What can be read: text against what lies behind it, and how large it is.
#include "app/panels/widgets/theme.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "sim/files/files.h"

using namespace insonate;
using namespace insonate::ui;

namespace {

/// One of red, green and blue, 0 to 1, over white as far as the colour is transparent.
double channel(ImU32 colour, int shift) {
  const double opaque = double(colour >> IM_COL32_A_SHIFT & 255) / 255;
  return opaque * double(colour >> shift & 255) / 255 + (1 - opaque);
}

/// Relative luminance as WCAG 2.1 defines it.
double luminance(ImU32 colour) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(channel(colour, IM_COL32_R_SHIFT)) + 0.7152 * linear(channel(colour, IM_COL32_G_SHIFT)) +
         0.0722 * linear(channel(colour, IM_COL32_B_SHIFT));
}

double contrast(ImU32 a, ImU32 b) {
  const double la = luminance(a), lb = luminance(b);
  return (std::max(la, lb) + 0.05) / (std::min(la, lb) + 0.05);
}

}  // namespace

TEST_CASE("all text can be read on what lies behind it, as WCAG 2.1 asks for at level AA") {
  CHECK(contrast(IM_COL32_WHITE, IM_COL32_BLACK) == Approx(21));
  CHECK(contrast(IM_COL32(118, 118, 118, 255), IM_COL32_WHITE) == Approx(4.54).margin(0.005));
  for (const colour::Writing& text : colour::writings()) {
    CAPTURE(text.ink, text.surface);
    CHECK(contrast(text.ink, text.surface) >= 4.5);
  }
}

TEST_CASE("no text is smaller than 13 pixels, on the smallest screen either") {
  ImGui::CreateContext();
  {
    Theme theme(assets_folder() / "fonts");
    for (const auto& [width, height] : {std::pair{1024.0f, 700.0f}, {1280.0f, 720.0f}, {2560.0f, 1440.0f}}) {
      theme.fit(width, height);
      for (const ImFont* font : ImGui::GetIO().Fonts->Fonts) CHECK(font->FontSize >= 13);
    }
  }
  ImGui::DestroyContext();
}
