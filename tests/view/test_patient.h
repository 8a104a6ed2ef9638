#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <functional>
#include <memory>

#include "sim/core/grid.h"
#include "sim/core/image.h"
#include "sim/gl/filter_error.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/view/body/patient_textures.h"
#include "sim/view/ultrasound_plane.h"

namespace insonate::test {

/// Returns a box around the origin with rotated, reflected and unequally spaced axes. Code that ignores the direction
/// matrix or the spacing fails with it.
inline Grid skewed_grid(double half_side_mm) {
  Grid grid;
  grid.spacing = {1.0, 1.5, 2.0};
  grid.size = glm::ivec3(glm::ceil(2 * half_side_mm / grid.spacing)) + 1;
  const glm::dmat3 turned(glm::rotate(glm::dmat4(1.0), 0.4, glm::normalize(glm::dvec3(0.3, 1, -0.5))));
  grid.direction = glm::dmat3(-turned[0], turned[1], turned[2]);
  grid.origin = -grid.direction * (grid.spacing * glm::dvec3(grid.size - 1) / 2.0);
  return grid;
}

/// Returns a CT whose values are `hu` of the patient's position.
inline Volume<std::int16_t> ct_of(const Grid& grid, const std::function<double(const glm::dvec3&)>& hu) {
  Volume<std::int16_t> ct{grid, std::vector<std::int16_t>(grid.count())};
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i)
        ct.at({i, j, k}) = std::int16_t(std::lround(hu(grid.patient_from_index({i, j, k}))));
  return ct;
}

inline Image<Rgba8> read(const gl::Texture& texture) {
  Image<Rgba8> image(texture.width(), texture.height());
  texture.read(GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data(), image.pixels.size() * sizeof(Rgba8));
  return image;
}

/// Returns what a graphics card's own filter adds to a difference in grey levels: a fifth of a level was measured in
/// slices, with weights of 7 bits (NVIDIA H100), and three levels where transfer functions are steep. A software
/// renderer's filter adds nothing.
inline double of_filter(double levels) {
  return gl::measure_filter().is_coarse() ? levels : 0;
}

/// A patient on the graphics card, with a picture of one colour as its ultrasound.
struct Scene {
  gl::Simulator simulator = in_context();
  std::unique_ptr<view::PatientTextures> patient;
  std::unique_ptr<gl::Texture> picture;
  view::UltrasoundPlane plane;

  Scene(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels, const view::OrganColours& colours) {
    const TissueTable table{{{-1000, 0.0004, 0, 0}, {1000, 7.8, 0, 0}}, {}};
    AcousticVolume volume{ct.grid, {}};  // of the CT as it is, which make_acoustic_volume() frees of noise
    for (const std::int16_t hu : ct.voxels) volume.voxels.push_back({hu, 0});
    simulator.set_volume(volume, table);
    patient = std::make_unique<view::PatientTextures>(simulator.volume_texture(), ct, labels, colours);
  }

  /// Fills the picture, `width` by `height` pixels of `mm`, centred below the probe's face, with `colour`. Alpha is 0
  /// where not `inside`; code that ignores alpha shows the colour there.
  void set_picture(
      int width, int height, double mm, const Rgba8& colour,
      const std::function<bool(int x, int y)>& inside = [](int, int) { return true; }) {
    Image<Rgba8> pixels(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        pixels.at(x, y) = inside(x, y) ? colour : Rgba8{colour[0], colour[1], colour[2], 0};
    picture = std::make_unique<gl::Texture>(gl::Texture::make_2d(GL_RGBA8, width, height, gl::Filter::linear));
    picture->write(GL_RGBA, GL_UNSIGNED_BYTE, pixels.pixels.data());
    plane.image = picture.get();
    ++plane.image_version;
    plane.geometry = {width, height, mm, {-mm * (width - 1) / 2, mm / 2}};
  }

  /// Makes the one context of all scenes of the program, because OpenGL objects live only in the context in which they
  /// were created. To be called before a view is made without a scene.
  static void need_context() { static const gl::HeadlessContext context; }

private:
  static gl::Simulator in_context() {
    need_context();
    return gl::Simulator();
  }
};

}  // namespace insonate::test
