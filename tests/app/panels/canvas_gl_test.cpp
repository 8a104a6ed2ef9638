#include <catch2/catch.hpp>

#include <random>
#include <string>

#include "app/panels/canvas.h"
#include "sim/core/image.h"
#include "tests/gl/test_context.h"

using namespace insonate;
using ui::Canvas;

namespace {

constexpr int kWidth = 333, kHeight = 222;  // no multiples of a tile

/// ImGui with a window's size that is scaled to kWidth x kHeight pixels.
struct TestImGui {
  explicit TestImGui(float scale = 1) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DisplaySize = {kWidth / scale, kHeight / scale};
    ImGui::GetIO().DisplayFramebufferScale = {scale, scale};
  }
  ~TestImGui() { ImGui::DestroyContext(); }
};

/// What a frame shows: shapes in places that may lie across the edges, some clipped to fractions of pixels.
struct Shape {
  ImVec2 at, size;
  ImVec4 clip;
  ImU32 colour = 0;
  int kind = 0;
};

Shape random_shape(std::mt19937& random) {
  const auto number = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  Shape shape;
  shape.at = {number(-20, kWidth), number(-20, kHeight)};
  shape.size = {number(1, 160), number(1, 120)};
  const float x = number(-10, kWidth), y = number(-10, kHeight);
  shape.clip =
      number(0, 1) < 0.5f ? ImVec4(0, 0, kWidth, kHeight) : ImVec4(x, y, x + number(1, 200), y + number(1, 150));
  shape.colour = ImU32(random()) | 0x40000000;
  shape.kind = int(random() % 4);
  return shape;
}

void draw_frame(const std::vector<Shape>& shapes, ImTextureID picture) {
  ImGui::NewFrame();
  ImDrawList* list = ImGui::GetForegroundDrawList();
  for (const Shape& shape : shapes) {
    const ImVec2 end{shape.at.x + shape.size.x, shape.at.y + shape.size.y};
    list->PushClipRect({shape.clip.x, shape.clip.y}, {shape.clip.z, shape.clip.w}, true);
    if (shape.kind == 0) list->AddRectFilled(shape.at, end, shape.colour, 5);
    if (shape.kind == 1) list->AddLine(shape.at, end, shape.colour, 2);
    if (shape.kind == 2) list->AddText(shape.at, shape.colour, "insonation");
    if (shape.kind == 3) list->AddImage(picture, shape.at, end);
    list->PopClipRect();
  }
  ImGui::Render();
}

Image<Rgba8> shown(const Canvas& canvas) {
  const gl::Texture target = gl::Texture::make_2d(GL_RGBA8, kWidth, kHeight, gl::Filter::nearest);
  const gl::Framebuffer framebuffer(target);
  framebuffer.bind();
  canvas.show();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  Image<Rgba8> image(kWidth, kHeight);
  target.read(GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data(), image.pixels.size() * sizeof(Rgba8));
  return image;
}

/// A texture of one colour, with the version that a canvas asks for.
struct Picture {
  gl::Texture texture = gl::Texture::make_2d(GL_RGBA8, 1, 1, gl::Filter::nearest);
  long version = 0;
  void paint(std::uint32_t colour) {
    texture.write(GL_RGBA, GL_UNSIGNED_BYTE, &colour);
    ++version;
  }
  ImTextureID id() const { return reinterpret_cast<ImTextureID>(std::uintptr_t(texture.name())); }
  Canvas::TextureVersion version_of() const {
    return [this](ImTextureID asked) { return asked == id() ? version : 0; };
  }
};

constexpr ImU32 kBackground = IM_COL32(20, 30, 40, 255);

}  // namespace

TEST_CASE("a canvas that redraws what changed shows the same as one that draws everything") {
  const test::TestContext context;
  const float scale = GENERATE(1.0f, 1.25f, 2.0f);
  const TestImGui imgui(scale);
  std::mt19937 random(5);
  Picture picture;
  picture.paint(0xff2080c0);
  std::vector<Shape> shapes(16);
  for (Shape& shape : shapes) shape = random_shape(random);
  Canvas canvas;
  canvas.make_fonts();
  for (int frame = 0; frame < 200; ++frame) {
    switch (frame % 4) {
      case 0:
        shapes[random() % shapes.size()] = random_shape(random);
        break;
      case 1:
        std::swap(shapes[random() % shapes.size()], shapes[random() % shapes.size()]);
        break;
      case 2:
        shapes.erase(shapes.begin() + long(random() % shapes.size()));
        shapes.push_back(random_shape(random));
        break;
      case 3:
        picture.paint(std::uint32_t(random()) | 0xff000000);
        break;
    }
    draw_frame(shapes, picture.id());
    canvas.draw(*ImGui::GetDrawData(), kBackground, picture.version_of());
    Canvas fresh;
    fresh.draw(*ImGui::GetDrawData(), kBackground, picture.version_of());
    INFO("frame " << frame << ", scale " << scale);
    REQUIRE(shown(canvas).pixels == shown(fresh).pixels);
  }
}

TEST_CASE("a canvas draws nothing for a frame that is equal to the one before, and little for a small change") {
  const test::TestContext context;
  const TestImGui imgui;
  Picture picture;
  picture.paint(0xff2080c0);
  Shape panel, word;
  panel.size = {kWidth, kHeight};
  panel.clip = word.clip = {0, 0, kWidth, kHeight};
  panel.colour = word.colour = IM_COL32_WHITE;
  word.kind = 2;
  word.at = {40, 70};
  Canvas canvas;
  canvas.make_fonts();
  const auto draw = [&] {
    draw_frame({panel, word}, picture.id());
    return canvas.draw(*ImGui::GetDrawData(), kBackground, picture.version_of());
  };
  CHECK(draw());
  CHECK(canvas.pixels_drawn() == kWidth * kHeight);
  CHECK_FALSE(draw());
  CHECK(canvas.pixels_drawn() == 0);

  word.colour = IM_COL32(255, 0, 0, 255);
  CHECK(draw());
  CHECK(canvas.pixels_drawn() > 0);
  CHECK(canvas.pixels_drawn() <= 4 * 32 * 32);  // the word is 70 pixels wide and lies in one row of tiles

  canvas.make_fonts();
  CHECK(draw());
  CHECK(canvas.pixels_drawn() == kWidth * kHeight);
}

TEST_CASE("a canvas enlarges a picture smoothly") {
  const test::TestContext context;
  const TestImGui imgui;
  const gl::Texture picture = GENERATE(true, false) ? gl::Texture::make_picture(4, 4, gl::Filter::linear)
                                                    : gl::Texture::make_2d(GL_RGBA8, 4, 4, gl::Filter::linear);
  std::array<std::uint32_t, 16> texels{};
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = i % 4 < 2 ? 0xff000000 : 0xffffffff;
  const_cast<gl::Texture&>(picture).write(GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  Canvas canvas;
  canvas.make_fonts();
  ImGui::NewFrame();
  ImGui::GetForegroundDrawList()->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(picture.name())), {10, 10},
                                           {210, 210});
  ImGui::Render();
  canvas.draw(*ImGui::GetDrawData(), kBackground, [](ImTextureID) { return 0; });
  const Image<Rgba8> image = shown(canvas);
  // From the middle of the second column of texels to that of the third.
  for (int x = 90; x < 130; ++x) {
    INFO("column " << x);
    CHECK(std::abs(image.at(x, kHeight - 100)[0] - 255 * (x + 0.5 - 85) / 50) < 4);
  }
}

TEST_CASE("a canvas mixes translucent shapes with what lies below, and lets opaque ones cover it") {
  const test::TestContext context;
  const TestImGui imgui;
  Canvas canvas;
  canvas.make_fonts();
  ImGui::NewFrame();
  ImDrawList* list = ImGui::GetForegroundDrawList();
  list->AddRectFilled({10, 10}, {110, 110}, IM_COL32(200, 0, 0, 255));
  list->AddRectFilled({10, 10}, {60, 110}, IM_COL32(0, 100, 0, 128));
  ImGui::Render();
  canvas.draw(*ImGui::GetDrawData(), kBackground, [](ImTextureID) { return 0; });
  const Image<Rgba8> image = shown(canvas);
  const auto is = [&](int x, const std::array<int, 3>& colour) {
    for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(image.at(x, kHeight - 50)[c] - colour[c]) <= 1);  // rounding
  };
  is(30, {100, 50, 0});
  is(90, {200, 0, 0});
  is(200, {20, 30, 40});
}

TEST_CASE("a picture in another colour is the picture times that colour, in every pixel") {
  const test::TestContext context;
  const TestImGui imgui;
  gl::Texture picture = gl::Texture::make_picture(kWidth, kHeight, gl::Filter::linear);
  std::vector<std::uint32_t> texels(std::size_t(kWidth) * kHeight);
  std::mt19937 random(3);
  for (std::uint32_t& texel : texels) texel = std::uint32_t(random()) | 0xff000000;
  picture.write(GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  const auto drawn_in = [&](ImU32 white) {
    Canvas canvas;
    canvas.make_fonts();
    ImGui::NewFrame();
    ImGui::GetForegroundDrawList()->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(picture.name())), {0, 0},
                                             {kWidth, kHeight}, {1, 0}, {0, 1}, white);
    ImGui::Render();
    canvas.draw(*ImGui::GetDrawData(), kBackground, [](ImTextureID) { return 0; });
    return canvas.read();
  };
  const Image<Rgba8> as_it_is = drawn_in(IM_COL32_WHITE), toned = drawn_in(IM_COL32(255, 200, 100, 255));
  const std::array<int, 3> factors{255, 200, 100};
  int worst = 0;
  for (std::size_t i = 0; i < toned.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(toned.pixels[i][c] - as_it_is.pixels[i][c] * factors[c] / 255));
  CHECK(worst <= 1);  // rounding
}
