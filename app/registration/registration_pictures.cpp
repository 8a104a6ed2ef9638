#include "app/registration/registration_pictures.h"

#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>

#include "sim/model/quality.h"
#include "sim/model/settings.h"

namespace insonate {
namespace {

constexpr std::array<int, 3> kOrange{256, 141, 26};  // of 256; blue is the rest to white

}  // namespace

FanView::FanView(const Probe& probe, double depth_mm, const ImageGeometry& geometry, const glm::dmat3& pixel_from_plane,
                 int width, int height)
    : pixel_from_plane_(pixel_from_plane),
      width_(width),
      height_(height),
      shown_width_(geometry.width),
      shown_height_(geometry.height) {
  for (int y = 0; y < geometry.height; ++y)
    for (int x = 0; x < geometry.width; ++x) {
      Source& source = sources_.emplace_back();
      const glm::dvec2 plane = geometry.plane_mm(x, y);
      const glm::dvec3 at = pixel_from_plane * glm::dvec3(plane, 1);
      const int left = int(std::floor(at.x)), top = int(std::floor(at.y));
      if (left < 0 || top < 0 || left + 1 >= width || top + 1 >= height) continue;
      if (!line_position(probe, depth_mm, plane)) continue;
      const int u = int(256 * (at.x - left)), v = int(256 * (at.y - top));
      source.at = top * width + left;
      source.weights[3] = std::uint16_t(u * v / 256);
      source.weights[2] = std::uint16_t(v - source.weights[3]);
      source.weights[1] = std::uint16_t(u - source.weights[3]);
      source.weights[0] = std::uint16_t(256 - u - source.weights[2]);
    }
}

bool FanView::fits(const LiveSession::Shown& shown) const {
  return shown.pixel_from_plane == pixel_from_plane_ && shown.image.grey.width == width_ &&
         shown.image.grey.height == height_;
}

Image<Rgba8> FanView::of(const Image<std::uint8_t>& image) const {
  Image<Rgba8> picture(shown_width_, shown_height_, Rgba8{0, 0, 0, 255});
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Source& source = sources_[i];
    if (source.at < 0) continue;
    const std::uint8_t* at = image.pixels.data() + source.at;
    const int sum = source.weights[0] * at[0] + source.weights[1] * at[1] + source.weights[2] * at[width_] +
                    source.weights[3] * at[width_ + 1];
    const auto level = std::uint8_t((sum + 128) / 256);
    picture.pixels[i] = {level, level, level, 255};
  }
  return picture;
}

Image<Rgba8> blend(const Image<Rgba8>& orange, const Image<Rgba8>& blue) {
  Image<Rgba8> both(orange.width, orange.height);
  for (std::size_t i = 0; i < both.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      both.pixels[i][c] =
          std::uint8_t((kOrange[c] * orange.pixels[i][c] + (256 - kOrange[c]) * blue.pixels[i][c] + 128) / 256);
    both.pixels[i][3] = 255;
  }
  return both;
}

RegistrationPictures::RegistrationPictures(const AcousticVolume& volume, const TissueTable& table) {
  simulator_.set_volume(volume, table);
  for (gl::Texture* texture : {&received_, &simulated_, &blended_})
    *texture = gl::Texture::make_picture(kWidth, kHeight, gl::Filter::linear);
}

bool RegistrationPictures::draw(const LiveSession& session) {
  const LiveSession::Shown* shown = session.newest();
  if (!shown) return false;
  const glm::dmat4 ct_from_sweep = session.state().ct_from_sweep;
  if (session.shown() == of_image_ && ct_from_sweep == at_) return false;
  of_image_ = session.shown();
  at_ = ct_from_sweep;
  const Probe& probe = *session.probe();
  if (!view_ || probe != probe_ || session.depth_mm() != depth_mm_) {
    view_.reset();
    probe_ = probe;
    depth_mm_ = session.depth_mm();
    Settings settings = at_quality(trainer_settings(probe.frequency_mhz, session.depth_mm()), Quality::fast);
    settings.image_width = kWidth;
    settings.image_height = kHeight;
    simulator_.set_probe(probe, session.depth_mm());
    simulator_.set_settings(settings);
  }
  const ImageGeometry geometry = image_geometry(probe, session.depth_mm(), kWidth, kHeight);
  const Image<std::uint8_t>& grey = shown->image.grey;
  if (!view_ || !view_->fits(*shown))
    view_.emplace(probe, session.depth_mm(), geometry, shown->pixel_from_plane, grey.width, grey.height);
  simulator_.set_pose(pose_from_matrix(ct_from_sweep * shown->sweep_from_fan.matrix()));
  Image<Rgba8> simulated(kWidth, kHeight);
  simulator_.image().read(GL_RGBA, GL_UNSIGNED_BYTE, simulated.pixels.data(), simulated.pixels.size() * sizeof(Rgba8));
  const Image<Rgba8> received = view_->of(grey);
  for (Rgba8& pixel : simulated.pixels)
    pixel = pixel[3] > 0 ? Rgba8{pixel[0], pixel[1], pixel[2], 255} : Rgba8{0, 0, 0, 255};
  const auto put = [](gl::Texture& texture, const Image<Rgba8>& picture) {
    texture.write(GL_RGBA, GL_UNSIGNED_BYTE, mirrored(picture).pixels.data());
  };
  put(received_, received);
  put(simulated_, simulated);
  put(blended_, blend(received, simulated));
  ++drawn_;
  return true;
}

}  // namespace insonate
