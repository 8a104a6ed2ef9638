#include "app/registration/registration_pictures.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "sim/model/quality.h"
#include "sim/model/settings.h"

namespace insonate {
namespace {

constexpr std::array<double, 3> kOrange{1.0, 0.55, 0.1};  // blue is the rest to white

}  // namespace

Image<Rgba8> image_in_fan(const LiveSession::Shown& shown, const Probe& probe, double depth_mm,
                          const ImageGeometry& geometry) {
  const Image<std::uint8_t>& grey = shown.image.grey;
  Image<Rgba8> picture(geometry.width, geometry.height, Rgba8{0, 0, 0, 255});
  for (int y = 0; y < geometry.height; ++y)
    for (int x = 0; x < geometry.width; ++x) {
      const glm::dvec2 plane = geometry.plane_mm(x, y);
      const glm::dvec3 at = shown.pixel_from_plane * glm::dvec3(plane, 1);
      const int left = int(std::floor(at.x)), top = int(std::floor(at.y));
      if (left < 0 || top < 0 || left + 1 >= grey.width || top + 1 >= grey.height) continue;
      if (!line_position(probe, depth_mm, plane)) continue;
      const double u = at.x - left, v = at.y - top;
      const double value = (1 - v) * ((1 - u) * grey.at(left, top) + u * grey.at(left + 1, top)) +
                           v * ((1 - u) * grey.at(left, top + 1) + u * grey.at(left + 1, top + 1));
      const auto level = std::uint8_t(std::lround(value));
      picture.at(x, y) = {level, level, level, 255};
    }
  return picture;
}

Image<Rgba8> blend(const Image<Rgba8>& orange, const Image<Rgba8>& blue) {
  Image<Rgba8> both(orange.width, orange.height);
  for (std::size_t i = 0; i < both.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      both.pixels[i][c] =
          std::uint8_t(std::lround(kOrange[c] * orange.pixels[i][c] + (1 - kOrange[c]) * blue.pixels[i][c]));
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
  if (!has_probe_) {
    has_probe_ = true;
    Settings settings = at_quality(trainer_settings(probe.frequency_mhz, session.depth_mm()), Quality::fast);
    settings.image_width = kWidth;
    settings.image_height = kHeight;
    simulator_.set_probe(probe, session.depth_mm());
    simulator_.set_settings(settings);
  }
  simulator_.set_pose(pose_from_matrix(ct_from_sweep * shown->sweep_from_fan.matrix()));
  Image<Rgba8> simulated(kWidth, kHeight);
  simulator_.image().read(GL_RGBA, GL_UNSIGNED_BYTE, simulated.pixels.data(), simulated.pixels.size() * sizeof(Rgba8));
  const Image<Rgba8> received = image_in_fan(*shown, probe, session.depth_mm(), simulator_.geometry());
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
