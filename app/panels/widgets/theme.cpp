#include "app/panels/widgets/theme.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sim/core/input_error.h"

namespace insonate::ui {
namespace {

/// Smaller text is hard to read on a laptop.
constexpr float kMinText_px = 13;

// Latin with its accents, and the other characters that the panels use: dashes, quotes, ellipsis, arrows.
constexpr ImWchar kGlyphs[] = {0x0020, 0x017f, 0x2010, 0x2027, 0x2190, 0x2195, 0x21ba, 0x21ba, 0x2212, 0x2212, 0};

ImFont* load(const std::filesystem::path& file, float size_px) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(file.string(), "", "the interface's font is missing", "install the program again");
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  config.PixelSnapH = false;
  return ImGui::GetIO().Fonts->AddFontFromFileTTF(file.string().c_str(), size_px, &config, kGlyphs);
}

}  // namespace

std::vector<colour::Writing> colour::writings() {
  std::vector<Writing> all{
      {kText, kHovered}, {kText, kAccentDark}, {kBackground, kAccent}, {kBackground, kAmber}, {kBackground, kRed}};
  for (const ImU32 surface : {kBackground, kPanel, kRaised, kImage, kPlate})
    for (const ImU32 ink : {kText, kMuted, kFaint, kAccent, kAmber, kRed, kExpert}) all.push_back({ink, surface});
  return all;
}

ImU32 colour::of(Tint tint) {
  return tint == Tint::grey   ? IM_COL32_WHITE
         : tint == Tint::warm ? IM_COL32(255, 236, 205, 255)
                              : IM_COL32(214, 232, 255, 255);
}

std::string depth_text(const Look& look, double depth_mm) {
  char text[32];
  if (look.length_unit == LengthUnit::mm)
    std::snprintf(text, sizeof text, "%.0f mm", depth_mm);
  else
    std::snprintf(text, sizeof text, "%.1f cm", depth_mm / 10);
  return text;
}

Theme::Theme(std::filesystem::path fonts) : folder_(std::move(fonts)) {
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowBorderSize = 0;
  style.WindowRounding = 0;
  style.WindowPadding = ImVec2(0, 0);
  style.ItemSpacing = ImVec2(0, 0);
  style.ScrollbarRounding = 6;
  const auto set = [&](ImGuiCol which, ImU32 colour) { style.Colors[which] = ImGui::ColorConvertU32ToFloat4(colour); };
  set(ImGuiCol_Text, colour::kText);
  set(ImGuiCol_WindowBg, colour::kBackground);
  set(ImGuiCol_FrameBg, colour::kRaised);
  set(ImGuiCol_FrameBgHovered, colour::kRaised);
  set(ImGuiCol_FrameBgActive, colour::kRaised);
  set(ImGuiCol_TextSelectedBg, colour::kAccentDark);
  set(ImGuiCol_ScrollbarBg, colour::kPanel);
  set(ImGuiCol_ScrollbarGrab, colour::kLine);
  set(ImGuiCol_ScrollbarGrabHovered, colour::kHovered);
  set(ImGuiCol_ScrollbarGrabActive, colour::kHovered);
}

bool Theme::fit(float width, float height, const Look& look) {
  // Scales in steps of an eighth, so that dragging a window's edge does not rebuild the fonts all the time.
  const float wanted = std::clamp(std::min(width / 1280, height / 800), 0.84f, 3.0f);
  const float scale = wanted < 1 ? 0.875f : std::floor(wanted * 8) / 8;
  const TextSize text_size_before = std::exchange(look_, look).text_size;
  if (scale == scale_ && look.text_size == text_size_before) return false;
  scale_ = scale;
  text_scale_ = look.text_size == TextSize::normal ? 1 : look.text_size == TextSize::large ? 1.12f : 1.25f;
  const auto size = [&](float at_1280) { return text_px(at_1280); };
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  const std::filesystem::path regular = folder_ / "Inter-Regular.otf", bold = folder_ / "Inter-SemiBold.otf";
  text = load(regular, size(16));
  small_text = load(regular, std::max(size(13.5f), kMinText_px));
  strong = load(bold, size(16));
  large = load(regular, size(24));
  title = load(bold, size(32));
  heading = load(bold, size(20));
  huge = load(bold, size(46));
  atlas.Build();
  return true;
}

}  // namespace insonate::ui
