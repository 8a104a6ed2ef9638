// Whether every letter over a picture has a plate below it: a picture may be as bright as it likes.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "app/panels/screen.h"
#include "devices/live/probe_buttons.h"
#include "tests/app/trainer/trainer_folder.h"
#include "tests/gl/test_context.h"

using namespace insonate;

namespace {

constexpr int kWidth = 1280, kHeight = 720;

/// What lies on each pixel of the screen, from ImGui's triangles in their order.
class Surfaces {
public:
  Surfaces() : of_(std::size_t(kWidth * kHeight), Surface::panel) {
    for (const ImFont* font : ImGui::GetIO().Fonts->Fonts)
      for (const ImFontGlyph& glyph : font->Glyphs) glyphs_.insert({glyph.U0, glyph.V0});
  }

  void take(const ImDrawData& frame) {
    for (int i = 0; i < frame.CmdListsCount; ++i) {
      const ImDrawList& list = *frame.CmdLists[i];
      for (const ImDrawCmd& command : list.CmdBuffer)
        for (unsigned k = 0; k + 2 < command.ElemCount; k += 3) {
          const auto corner = [&](unsigned n) {
            return list.VtxBuffer[int(command.VtxOffset + list.IdxBuffer[int(command.IdxOffset + k + n)])];
          };
          take(command, {corner(0), corner(1), corner(2)});
        }
    }
  }

  int pictures = 0, letters_on_plates = 0, bare_letters = 0;
  ImVec2 bare{};  ///< where one is

private:
  enum class Surface : char { panel, picture, plate };

  void take(const ImDrawCmd& command, const std::array<ImDrawVert, 3>& corners) {
    float low_x = 1e9f, low_y = 1e9f, high_x = 0, high_y = 0;
    bool is_letter = false;
    for (const ImDrawVert& corner : corners) {
      low_x = std::min(low_x, corner.pos.x);
      low_y = std::min(low_y, corner.pos.y);
      high_x = std::max(high_x, corner.pos.x);
      high_y = std::max(high_y, corner.pos.y);
      is_letter = is_letter || glyphs_.contains({corner.uv.x, corner.uv.y});
    }
    const ImVec4& clip = command.ClipRect;
    low_x = std::max({low_x, clip.x, 0.0f});
    low_y = std::max({low_y, clip.y, 0.0f});
    high_x = std::min({high_x, clip.z, float(kWidth)});
    high_y = std::min({high_y, clip.w, float(kHeight)});
    if (low_x >= high_x || low_y >= high_y) return;
    if (command.GetTexID() != ImGui::GetIO().Fonts->TexID) {
      ++pictures;
      return put(Surface::picture, corners, low_x, low_y, high_x, high_y);
    }
    if (is_letter) return see_letter({(low_x + high_x) / 2, (low_y + high_y) / 2});
    constexpr unsigned kOpaque = 230;
    const bool opaque = (corners[0].col >> IM_COL32_A_SHIFT) >= kOpaque &&
                        (corners[1].col >> IM_COL32_A_SHIFT) >= kOpaque &&
                        (corners[2].col >> IM_COL32_A_SHIFT) >= kOpaque;
    if (opaque) put(Surface::plate, corners, low_x, low_y, high_x, high_y);
  }

  void put(Surface surface, const std::array<ImDrawVert, 3>& corners, float low_x, float low_y, float high_x,
           float high_y) {
    const auto side = [&](int a, int b, float x, float y) {
      const ImVec2 &from = corners[std::size_t(a)].pos, &to = corners[std::size_t(b)].pos;
      return (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
    };
    for (int y = int(low_y); y < int(std::ceil(high_y)); ++y)
      for (int x = int(low_x); x < int(std::ceil(high_x)); ++x) {
        const float px = float(x) + 0.5f, py = float(y) + 0.5f;
        const float a = side(0, 1, px, py), b = side(1, 2, px, py), c = side(2, 0, px, py);
        if ((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0)) at(x, y) = surface;
      }
  }

  void see_letter(const ImVec2& middle) {
    switch (at(int(middle.x), int(middle.y))) {
      case Surface::panel:
        break;
      case Surface::picture:
        ++bare_letters;
        bare = middle;
        break;
      case Surface::plate:
        ++letters_on_plates;
        break;
    }
  }

  Surface& at(int x, int y) { return of_[std::size_t(y) * kWidth + std::size_t(x)]; }

  std::vector<Surface> of_;
  std::set<std::pair<float, float>> glyphs_;  ///< upper left corners in the texture
};

}  // namespace

TEST_CASE("every letter over a picture has a plate below it") {
  const test::TestContext context;
  const TrainerFolder folder;
  Options options = folder.options();
  options.tracker = "mouse:";
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.session());
  trainer.start();
  ui::Screen screen;
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(float(kWidth), float(kHeight));
  io.DeltaTime = 1.0f / 30;
  double now_s = 0;
  for (std::size_t layout = 0; layout < kLayoutNames.size(); ++layout) {
    screen.choose(LayoutName(layout), trainer);
    for (int frame = 0; frame < 4; ++frame) {
      trainer.update(now_s += 1.0 / 30);
      if (frame == 1) trainer.session()->press(kEventMarkerButton);
      trainer.draw(screen.picture_sizes(trainer, float(kWidth), float(kHeight)));
      screen.render(trainer);
    }
    Surfaces surfaces;
    surfaces.take(*ImGui::GetDrawData());
    CAPTURE(kLayoutNames[layout], surfaces.bare.x, surfaces.bare.y);
    CHECK(surfaces.pictures >= 6);  // of two triangles each
    CHECK(surfaces.letters_on_plates > 80);
    CHECK(surfaces.bare_letters == 0);
  }
}
