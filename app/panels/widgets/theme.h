#pragma once

#include <imgui.h>

#include <filesystem>
#include <string>
#include <vector>

#include "app/trainer/look.h"

namespace insonate::ui {

/// Colours: near black, greys, and one accent. Amber and red mean that something is wrong. The only exception is red
/// for a running recording. Text has a contrast of at least 4.5 : 1 (WCAG 2.1, level AA) on all of writings().
namespace colour {
inline constexpr ImU32 kBackground = IM_COL32(10, 12, 15, 255);
inline constexpr ImU32 kPanel = IM_COL32(18, 22, 27, 255);
inline constexpr ImU32 kRaised = IM_COL32(31, 38, 46, 255);
inline constexpr ImU32 kHovered = IM_COL32(43, 52, 62, 255);
inline constexpr ImU32 kLine = IM_COL32(40, 48, 57, 255);
inline constexpr ImU32 kText = IM_COL32(232, 236, 240, 255);
inline constexpr ImU32 kMuted = IM_COL32(152, 164, 176, 255);
inline constexpr ImU32 kFaint = IM_COL32(132, 144, 156, 255);
inline constexpr ImU32 kAccent = IM_COL32(74, 190, 204, 255);
inline constexpr ImU32 kAccentDark = IM_COL32(24, 74, 82, 255);
inline constexpr ImU32 kAmber = IM_COL32(236, 172, 62, 255);
inline constexpr ImU32 kRed = IM_COL32(240, 110, 100, 255);
inline constexpr ImU32 kExpert = IM_COL32(226, 214, 244, 255);  ///< of a run beside the replayed one
inline constexpr ImU32 kImage = IM_COL32(0, 0, 0, 255);
inline constexpr ImU32 kDim = IM_COL32(4, 6, 8, 190);
inline constexpr ImU32 kPlate = IM_COL32(10, 12, 15, 235);  ///< below text on a picture, however bright that is

/// Returns the colour of the ultrasound's white.
ImU32 of(Tint tint);

/// Text of one colour on a surface of another.
struct Writing {
  ImU32 ink, surface;
};
/// Returns every ink on every surface on which the panels write with it: all inks on the dark surfaces, and only one on
/// each of the others.
std::vector<Writing> writings();
}  // namespace colour

/// Margins inside of a box and of a bar, in the units of Theme::px().
inline constexpr float kMargin = 8, kWideMargin = 16;

/// Returns a depth in the person's unit: "16.0 cm" or "160 mm".
std::string depth_text(const Look& look, double depth_mm);

/// Font sizes and lengths, all in proportion to the screen. Needs an ImGui context; only one Theme may exist at a time.
class Theme {
public:
  /// @param fonts  the folder with the interface's fonts
  explicit Theme(std::filesystem::path fonts);

  /// Adapts the fonts to the size of the screen, in pixels, and takes the person's preferences. Returns true if the
  /// fonts were rebuilt; the renderer must then take the new font texture. To be called between frames.
  bool fit(float width, float height, const Look& look = {});

  const Look& look() const { return look_; }

  /// Scales a length that is given for a screen of 1280 x 800.
  float px(float at_1280) const { return at_1280 * scale_; }
  /// Scales a length that has to grow with the size of the text.
  float text_px(float at_1280) const { return at_1280 * scale_ * text_scale_; }

  ImFont* small_text = nullptr;
  ImFont* text = nullptr;
  ImFont* strong = nullptr;
  ImFont* large = nullptr;  ///< regular, readable from a step away
  ImFont* title = nullptr;
  ImFont* heading = nullptr;
  ImFont* huge = nullptr;

private:
  std::filesystem::path folder_;
  Look look_;
  float scale_ = 0, text_scale_ = 1;
};

}  // namespace insonate::ui
