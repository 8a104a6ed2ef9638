#include "sim/view/body/swept_view.h"

#include <array>
#include <vector>

#include "sim/view/body/patient_textures.h"
#include "sim/view/body/voxel_box.h"

namespace insonate::view {
namespace {

// Each pass of (1 2 1)/4 has a variance of half a voxel.
constexpr int kSmoothings = 4;

Volume<std::int16_t> smoothed(const Volume<std::uint8_t>& grey, const Volume<std::uint8_t>& known) {
  const Box box{grey.grid.size};
  std::vector<std::array<std::int16_t, 1>> values(box.count());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = {std::int16_t(known.voxels[i] ? SweptView::kValuePerGrey * grey.voxels[i] : 0)};
  for (int pass = 0; pass < kSmoothings; ++pass) smooth(box, values);
  Volume<std::int16_t> volume{grey.grid, std::vector<std::int16_t>(box.count())};
  for (std::size_t i = 0; i < values.size(); ++i) volume.voxels[i] = values[i][0];
  return volume;
}

// As the simulator stores a CT (shared/acoustic_volume.glsl), whose first component alone is read here.
gl::Texture texture_of(const Volume<std::int16_t>& volume) {
  const glm::ivec3 size = volume.grid.size + 2;
  gl::Texture texture = gl::Texture::make_3d(GL_R16_SNORM, size.x, size.y, size.z, gl::Filter::linear, gl::Wrap::edge);
  texture.write_inside(GL_RED, GL_SHORT, volume.voxels.data(), std::int16_t(0));
  return texture;
}

}  // namespace

TransferFunction swept_function(const SweptLook& look) {
  const auto at = [](double grey, const glm::dvec3& colour, double opacity) {
    return TransferPoint{SweptView::kValuePerGrey * grey, colour, opacity};
  };
  const double middle = (look.threshold + 255) / 2;
  return {"",
          {at(look.threshold, {0.42, 0.20, 0.10}, 0), at(middle, {0.85, 0.58, 0.36}, look.opacity / 2),
           at(255, {1.0, 0.93, 0.82}, look.opacity)}};
}

struct SweptView::State {
  State(const Volume<std::uint8_t>& grey, const Volume<std::uint8_t>& known, const gl::ShaderSources& sources)
      : values(smoothed(grey, known)),
        texture(texture_of(values)),
        patient(texture, values, no_labels, {}),
        view(sources) {}

  Volume<std::uint8_t> no_labels;
  Volume<std::int16_t> values;
  gl::Texture texture;
  PatientTextures patient;
  VolumeView view;
};

SweptView::SweptView(const Volume<std::uint8_t>& grey, const Volume<std::uint8_t>& known,
                     const gl::ShaderSources& sources)
    : state_(std::make_unique<State>(grey, known, sources)) {}
SweptView::~SweptView() = default;

const gl::Texture& SweptView::render(int width, int height, const OrbitCamera& camera, const SweptLook& look,
                                     const UltrasoundPlane& face, const VolumeBudget& budget) {
  VolumeStyle style;
  style.cut = style.plane = face.image != nullptr;
  style.probe = false;
  style.cut_face = 0;
  style.ct.emplace();
  style.ct->function = swept_function(look);
  style.ct->body_only = false;
  return state_->view.render(width, height, state_->patient, camera, face, style, budget);
}

long SweptView::renders() const {
  return state_->view.renders();
}

}  // namespace insonate::view
