#include "app/panels/replay/recorded_panel.h"

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/panels/scan/picture_plates.h"
#include "app/panels/scan/ultrasound_panel.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate::ui {
namespace {

/// Describes how far an image lies from the simulated plane; empty if it lies in that plane.
std::string off_plane_text(const std::array<glm::dvec3, 4>& corners) {
  constexpr double kTilt_deg = 3, kOffset_mm = 3;
  const glm::dvec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[3] - corners[0]));
  const double tilt_deg = glm::degrees(std::acos(std::min(std::abs(normal.z), 1.0)));
  const double offset_mm = std::abs(corners[0].z + corners[2].z) / 2;
  if (tilt_deg < kTilt_deg && offset_mm < kOffset_mm) return "";
  return formatted("%.0f\u00b0 and %.0f mm off the simulated plane", tilt_deg, offset_mm);
}

void draw_image(const gl::Texture& texture, const std::array<ImVec2, 4>& corners) {
  ImGui::GetWindowDrawList()->AddImageQuad(reinterpret_cast<ImTextureID>(std::uintptr_t(texture.name())), corners[0],
                                           corners[1], corners[2], corners[3], {0, 0}, {1, 0}, {1, 1}, {0, 1});
}

/// Returns the corners of an image that is as large as fits, with the marker's side on the left or the right.
std::array<ImVec2, 4> fitted(const Rect& area, int width, int height, MarkerSide marker) {
  const float scale = std::min(area.w / float(width), area.h / float(height));
  const float half_w = (marker == MarkerSide::left ? 1 : -1) * scale * float(width) / 2,
              half_h = scale * float(height) / 2;
  const float x = area.x + area.w / 2, y = area.y + area.h / 2;
  return {ImVec2{x + half_w, y - half_h}, {x - half_w, y - half_h}, {x - half_w, y + half_h}, {x + half_w, y + half_h}};
}

}  // namespace

std::optional<std::array<glm::dvec3, 4>> image_corners(const RecordedImages& images, std::size_t sample) {
  const std::optional<glm::dmat4>& probe_from_pixel = images.frames[sample].probe_from_pixel;
  if (!probe_from_pixel) return std::nullopt;
  // Pixel coordinates refer to the pixel's centre.
  const double right = double(images.form.width) - 0.5, bottom = double(images.form.height) - 0.5;
  const auto at = [&](double x, double y) { return glm::dvec3(*probe_from_pixel * glm::dvec4(x, y, 0, 1)); };
  return std::array{at(-0.5, -0.5), at(right, -0.5), at(right, bottom), at(-0.5, bottom)};
}

RecordedPanel::RecordedPanel() = default;
RecordedPanel::~RecordedPanel() = default;

void RecordedPanel::show(const Replay& replay) {
  const RecordedRun& run = replay.run();
  const std::size_t sample = run.index_at(replay.time_s());
  if (replay_ == &replay && sample_ == sample) return;
  try {
    if (replay_ != &replay) {
      reader_ = std::make_unique<ImageReader>(*run.images);
      texture_ = {};
    }
    replay_ = &replay;
    sample_ = sample;
    const Image<std::uint8_t>& grey = reader_->grey(run.images->frames[sample].number);
    std::vector<Rgba8> pixels(grey.pixels.size());
    std::transform(grey.pixels.begin(), grey.pixels.end(), pixels.begin(), [](std::uint8_t value) {
      return Rgba8{value, value, value, 255};
    });
    if (!texture_) texture_ = gl::Texture::make_picture(grey.width, grey.height, gl::Filter::linear);
    texture_.write(GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    ++shown_;
    problem_.clear();
  } catch (const InputError& error) {
    problem_ = error.what();
  } catch (const gl::DeviceRefused& error) {
    problem_ = error.what();
  }
}

void RecordedPanel::draw(const Theme& theme, const Rect& panel, const Replay& replay, const Pictures& pictures) {
  show(replay);
  fill(panel, colour::kImage, theme.px(4));
  Rect line{panel.x + theme.px(16), panel.y + theme.px(12), panel.w - theme.px(32), theme.px(24)};
  if (!problem_.empty()) {
    draw_paragraph(panel.inset(theme.px(16), theme.px(48)), theme.text, colour::kAmber, problem_);
  } else {
    const RecordedImages& images = *replay.run().images;
    const Rect area = UltrasoundPanel::picture_area(theme, panel);
    const auto corners = pictures.ultrasound() ? image_corners(images, *sample_) : std::nullopt;
    std::array<ImVec2, 4> on_screen =
        fitted(area, int(images.form.width), int(images.form.height), theme.look().marker);
    std::string note = "Place unknown: the recording has no ImageToProbe";
    if (corners) {
      const PlaneOnScreen plane = UltrasoundPanel::plane(theme, panel, pictures);
      for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2 p = plane.screen((*corners)[i]);
        on_screen[i] = {float(p.x), float(p.y)};
      }
      note = off_plane_text(*corners);
    }
    ImGui::PushClipRect(area.min(), area.max(), true);
    draw_image(texture_, on_screen);
    ImGui::PopClipRect();
    draw_on_plate(theme, {line.x, line.y + line.h, line.w, theme.px(19)}, theme.small_text, colour::kMuted, note);
  }
  draw_on_plate(theme, line, theme.strong, colour::kText, "Recorded");
}

}  // namespace insonate::ui
