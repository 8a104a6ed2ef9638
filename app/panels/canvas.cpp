#include "app/panels/canvas.h"

#include <epoxy/gl.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace insonate::ui {
namespace {

/// Small enough that a changed word redraws little around it, large enough that the hashes of a whole window take less
/// than a millisecond.
constexpr int kTile = 32;

bool is_empty(const PixelBox& box) {
  return box.x >= box.end_x || box.y >= box.end_y;
}

PixelBox common(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::min(a.end_x, b.end_x), std::min(a.end_y, b.end_y)};
}

/// Places a frame's coordinates on the canvas.
struct Place {
  ImVec2 origin, scale;

  explicit Place(const ImDrawData& frame) : origin(frame.DisplayPos), scale(frame.FramebufferScale) {}
  ImVec2 pixel(const ImVec2& at) const { return {(at.x - origin.x) * scale.x, (at.y - origin.y) * scale.y}; }
  /// Returns the pixels whose area touches a rectangle.
  PixelBox around(const ImVec2& low, const ImVec2& high) const {
    const ImVec2 from = pixel(low), to = pixel(high);
    return {int(std::floor(from.x)), int(std::floor(from.y)), int(std::ceil(to.x)), int(std::ceil(to.y))};
  }
  /// Returns the pixels inside a clip rectangle.
  PixelBox inside(const ImVec4& rect) const {
    const ImVec2 from = pixel({rect.x, rect.y}), to = pixel({rect.z, rect.w});
    return {int(from.x), int(from.y), int(to.x), int(to.y)};
  }
};

constexpr GLint kWhite = 0;                            // as sim/shaders/window/toned.frag has it
constexpr GLuint kPosition = 0, kUv = 1, kColour = 2;  // as sim/shaders/window/shape.vert has them

GLuint name_of(ImTextureID texture) {
  return GLuint(reinterpret_cast<std::uintptr_t>(texture));
}

bool is_opaque(const ImDrawVert& corner) {
  return corner.col >> IM_COL32_A_SHIFT == 0xff;
}

}  // namespace

Canvas::Canvas()
    : plain_({}, {"window/shape.vert", "window/plain.frag"}),
      picture_program_({}, {"window/shape.vert", "window/picture.frag"}),
      toned_({}, {"window/shape.vert", "window/toned.frag"}),
      tinted_({}, {"window/shape.vert", "window/tinted.frag"}) {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  corner_layout_ = gl::Object<gl::VertexArrayKind>(name);
  for (const GLuint attribute : {kPosition, kUv, kColour}) {
    glEnableVertexArrayAttrib(name, attribute);
    glVertexArrayAttribBinding(name, attribute, 0);
  }
  glVertexArrayAttribFormat(name, kPosition, 2, GL_FLOAT, GL_FALSE, offsetof(Corner, pos));
  glVertexArrayAttribFormat(name, kUv, 2, GL_FLOAT, GL_FALSE, offsetof(Corner, uv));
  glVertexArrayAttribFormat(name, kColour, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Corner, col));
  ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
}

void Canvas::make_fonts() {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  fonts.GetTexDataAsRGBA32(&pixels, &width, &height);
  fonts_ = gl::Texture::make_2d(GL_RGBA8, width, height, gl::Filter::linear);
  fonts_.write(GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  fonts.SetTexID(reinterpret_cast<ImTextureID>(std::uintptr_t(fonts_.name())));
  hashes_.clear();
}

void Canvas::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  picture_ = gl::Texture::make_picture(width, height, gl::Filter::nearest);
  framebuffer_ = gl::Framebuffer(picture_);
  width_ = width;
  height_ = height;
  columns_ = (width + kTile - 1) / kTile;
  rows_ = (height + kTile - 1) / kTile;
  hashes_.clear();
}

void Canvas::add(Kind kind, ImTextureID texture, const PixelBox& clip, const PixelBox& bounds,
                 const std::array<ImDrawVert, 3>& corners) {
  Batch* last = batches_.empty() ? nullptr : &batches_.back();
  const bool reads = kind == Kind::picture || kind == Kind::toned || kind == Kind::tinted;
  if (!last || last->kind != kind || kind == Kind::toned || (reads && last->texture != texture) || last->clip != clip) {
    batches_.push_back({kind, texture, clip, bounds, int(corners_.size()), 0});
    last = &batches_.back();
  }
  last->bounds = {std::min(last->bounds.x, bounds.x), std::min(last->bounds.y, bounds.y),
                  std::max(last->bounds.end_x, bounds.end_x), std::max(last->bounds.end_y, bounds.end_y)};
  last->count += 3;
  corners_.insert(corners_.end(), corners.begin(), corners.end());
}

// Fills in batches_, corners_ and hashes_.
void Canvas::take(const ImDrawData& frame, const TextureVersion& version_of) {
  constexpr std::uint64_t kOddFactor = 0x9e3779b97f4a7c15;  // spreads each triangle's bits, and makes the order count
  const Place place(frame);
  const PixelBox all{0, 0, width_, height_};
  const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
  batches_.clear();
  corners_.clear();
  hashes_.assign(std::size_t(columns_) * std::size_t(rows_), 0);
  for (int i = 0; i < frame.CmdListsCount; ++i) {
    const ImDrawList& list = *frame.CmdLists[i];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const PixelBox clip = common(all, place.inside(command.ClipRect));
      if (is_empty(clip)) continue;
      const ImTextureID texture = command.GetTexID();
      const bool is_picture = texture != ImGui::GetIO().Fonts->TexID;
      const struct {
        ImTextureID texture;
        long version;
        PixelBox clip;
      } drawn_with{texture, version_of(texture), clip};
      const std::uint64_t seed = XXH3_64bits(&drawn_with, sizeof drawn_with);
      for (unsigned first = 0; first < command.ElemCount; first += 3) {
        std::array<ImDrawVert, 3> corners;
        for (unsigned c = 0; c < 3; ++c)
          corners[c] = list.VtxBuffer[int(command.VtxOffset) + list.IdxBuffer[int(command.IdxOffset + first + c)]];
        const auto [left, right] = std::minmax({corners[0].pos.x, corners[1].pos.x, corners[2].pos.x});
        const auto [top, bottom] = std::minmax({corners[0].pos.y, corners[1].pos.y, corners[2].pos.y});
        const PixelBox bounds = common(clip, place.around({left, top}, {right, bottom}));
        if (is_empty(bounds)) continue;

        const std::uint64_t triangle = XXH3_64bits_withSeed(corners.data(), sizeof corners, seed);
        for (int row = bounds.y / kTile; row <= (bounds.end_y - 1) / kTile; ++row)
          for (int column = bounds.x / kTile; column <= (bounds.end_x - 1) / kTile; ++column) {
            std::uint64_t& hash = hashes_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
            hash = (hash ^ triangle) * kOddFactor;
          }

        const auto each = [&](auto is) { return std::all_of(corners.begin(), corners.end(), is); };
        Kind kind = Kind::tinted;
        const bool one_colour = each([&](const ImDrawVert& corner) { return corner.col == corners[0].col; });
        if (is_picture && one_colour && is_opaque(corners[0]))
          kind =
              each([](const ImDrawVert& corner) { return corner.col == IM_COL32_WHITE; }) ? Kind::picture : Kind::toned;
        else if (!is_picture && each([&](const ImDrawVert& c) { return c.uv.x == white.x && c.uv.y == white.y; }))
          kind = each(is_opaque) ? Kind::covering : Kind::plain;
        for (ImDrawVert& corner : corners) {
          const ImVec2 at = place.pixel(corner.pos);
          corner.pos = {2 * at.x / float(width_) - 1, 1 - 2 * at.y / float(height_)};
        }
        add(kind, texture, clip, bounds, corners);
      }
    }
  }
}

std::vector<PixelBox> Canvas::changed_boxes(const std::vector<std::uint64_t>& before) const {
  if (before.empty()) return {{0, 0, width_, height_}};
  std::vector<PixelBox> boxes;
  const auto changed = [&](int row, int column) {
    const std::size_t tile = std::size_t(row) * std::size_t(columns_) + std::size_t(column);
    return hashes_[tile] != before[tile];
  };
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      if (!changed(row, column)) continue;
      int end = column + 1;
      while (end < columns_ && changed(row, end)) ++end;
      const PixelBox run{column * kTile, row * kTile, std::min(end * kTile, width_),
                         std::min((row + 1) * kTile, height_)};
      // A run below one of the same columns makes it taller.
      const auto above = std::find_if(boxes.begin(), boxes.end(), [&](const PixelBox& box) {
        return box.end_y == run.y && box.x == run.x && box.end_x == run.end_x;
      });
      if (above != boxes.end())
        above->end_y = run.end_y;
      else
        boxes.push_back(run);
      column = end;
    }
  return boxes;
}

const gl::Program& Canvas::program_of(Kind kind) const {
  switch (kind) {
    case Kind::plain:
    case Kind::covering:
      return plain_;
    case Kind::picture:
      return picture_program_;
    case Kind::toned:
      return toned_;
    case Kind::tinted:
      return tinted_;
  }
  return plain_;
}

void Canvas::draw_batches() const {
  const gl::Buffer corners(corners_.size() * sizeof(Corner), corners_.data());
  glVertexArrayVertexBuffer(corner_layout_.name(), 0, corners.name(), 0, sizeof(Corner));
  glBindVertexArray(corner_layout_.name());
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  for (const Batch& batch : batches_) {
    const bool blends = batch.kind == Kind::plain || batch.kind == Kind::tinted;
    (blends ? glEnable : glDisable)(GL_BLEND);
    program_of(batch.kind).use();
    if (batch.kind == Kind::toned) {
      const ImVec4 white = ImGui::ColorConvertU32ToFloat4(corners_[std::size_t(batch.first)].col);
      glUniform4f(kWhite, white.x, white.y, white.z, white.w);
    }
    glBindTextureUnit(0, name_of(batch.texture));
    for (const PixelBox& box : drawn_) {
      const PixelBox part = common(box, batch.bounds);
      if (is_empty(part)) continue;
      glScissor(part.x, height_ - part.end_y, part.end_x - part.x, part.end_y - part.y);
      glDrawArrays(GL_TRIANGLES, batch.first, batch.count);
    }
  }
  glBindVertexArray(0);
  glBindTextureUnit(0, 0);
  glDisable(GL_BLEND);
}

bool Canvas::draw(const ImDrawData& frame, ImU32 background, const TextureVersion& version_of) {
  resize(int(frame.DisplaySize.x * frame.FramebufferScale.x), int(frame.DisplaySize.y * frame.FramebufferScale.y));
  const std::vector<std::uint64_t> before = std::exchange(hashes_, {});
  take(frame, version_of);
  drawn_ = changed_boxes(before);
  if (drawn_.empty()) return false;

  GLint previous = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &previous);
  framebuffer_.bind();
  const ImVec4 colour = ImGui::ColorConvertU32ToFloat4(background);
  glClearColor(colour.x, colour.y, colour.z, 1);
  glEnable(GL_SCISSOR_TEST);
  for (const PixelBox& box : drawn_) {
    glScissor(box.x, height_ - box.end_y, box.end_x - box.x, box.end_y - box.y);
    glClear(GL_COLOR_BUFFER_BIT);
  }
  if (!corners_.empty()) draw_batches();
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, GLuint(previous));
  return true;
}

long Canvas::pixels_drawn() const {
  long pixels = 0;
  for (const PixelBox& box : drawn_) pixels += long(box.end_x - box.x) * (box.end_y - box.y);
  return pixels;
}

Image<Rgba8> Canvas::read(const PixelBox& box) const {
  Image<Rgba8> upside_down(box.end_x - box.x, box.end_y - box.y);
  GLint previous = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &previous);
  framebuffer_.bind();
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(box.x, height_ - box.end_y, upside_down.width, upside_down.height, GL_RGBA, GL_UNSIGNED_BYTE,
               upside_down.pixels.data());
  glBindFramebuffer(GL_FRAMEBUFFER, GLuint(previous));
  Image<Rgba8> picture = upright(upside_down);
  for (Rgba8& pixel : picture.pixels) pixel[3] = 255;  // what has been blended is not transparent
  return picture;
}

void Canvas::show(const PixelBox& box) const {
  GLint target = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &target);
  framebuffer_.copy_to(GLuint(target), {box.x, height_ - box.end_y}, {box.end_x, height_ - box.y});
}

}  // namespace insonate::ui
