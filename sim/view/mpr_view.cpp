#include "sim/view/mpr_view.h"

#include <epoxy/gl.h>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <optional>
#include <vector>

#include "sim/gl/streamed_buffer.h"
#include "sim/shaders/view/mpr_parameters.h"
#include "sim/view/picture_target.h"

namespace insonate::view {
namespace {

const glm::vec4 kUnseen(0.055f, 0.067f, 0.082f, 1);
const glm::vec4 kFilledTint(0.72f, 0.86f, 1.0f, 1);

MprParameters parameters_for(const Grid& grid, const MprPicture& picture) {
  glm::dmat4 picture_from_pixel(1.0);
  picture_from_pixel[0][0] = picture_from_pixel[1][1] = picture.mm_per_pixel;
  const glm::dvec2 first = -picture.mm_per_pixel * (glm::dvec2(picture.width, picture.height) - 1.0) / 2.0;
  picture_from_pixel[3] = glm::dvec4(first, 0, 1);
  MprParameters p{};
  p.index_from_pixel =
      glm::mat4(glm::inverse(grid.matrix()) * picture.patient_from_picture.matrix() * picture_from_pixel);
  p.unseen = picture.unseen_clear ? glm::vec4(glm::vec3(kUnseen), 0) : kUnseen;
  p.filled_tint = picture.tints_filled ? kFilledTint : glm::vec4(1.0f);
  return p;
}

struct MprInputs {
  GLuint volume;
  MprPicture picture;
  bool operator==(const MprInputs&) const = default;
};

}  // namespace

SweptTexture::SweptTexture(const Volume<std::uint8_t>& grey, const Volume<std::uint8_t>& known)
    : grid_(grey.grid),
      texture_(
          gl::Texture::make_3d(GL_RG8, grid_.size.x, grid_.size.y, grid_.size.z, gl::Filter::nearest, gl::Wrap::edge)) {
  constexpr std::array<std::uint8_t, 3> kStates{0, 128, 255};
  std::vector<std::array<std::uint8_t, 2>> texels(grid_.count());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, texels.size(), 1u << 18), [&](const auto& range) {
    for (std::size_t n = range.begin(); n < range.end(); ++n)
      texels[n] = {grey.voxels[n], kStates[std::min<std::size_t>(known.voxels[n], 2)]};
  });
  texture_.write(GL_RG, GL_UNSIGNED_BYTE, texels.data());
}

struct MprView::State {
  explicit State(const gl::ShaderSources& sources) : program(sources, {"view/full_screen.vert", "view/mpr.frag"}) {}

  gl::Program program;
  gl::FullScreenTriangle triangle;
  gl::StreamedBuffer parameters;
  PictureTarget target;
  std::optional<MprInputs> drawn;
  long renders = 0;
};

MprView::MprView(const gl::ShaderSources& sources) : state_(std::make_unique<State>(sources)) {}
MprView::~MprView() = default;
MprView::MprView(MprView&&) noexcept = default;
MprView& MprView::operator=(MprView&&) noexcept = default;

const gl::Texture& MprView::render(const SweptTexture& volume, const MprPicture& picture) {
  State& s = *state_;
  const MprInputs inputs{volume.texture().name(), picture};
  if (s.drawn == inputs) return s.target.texture;
  s.target.resize(picture.width, picture.height);
  const MprParameters parameters = parameters_for(volume.grid(), picture);
  s.parameters.write(&parameters, sizeof parameters);
  s.parameters.bind_uniform(0);
  volume.texture().bind(0);
  {
    const ScopedDrawTarget drawing(s.target.framebuffer, 0, picture.height);
    s.program.use();
    s.triangle.draw();
  }
  ++s.renders;
  s.drawn = inputs;
  return s.target.texture;
}

void MprView::forget() {
  state_->drawn.reset();
}

long MprView::renders() const {
  return state_->renders;
}

}  // namespace insonate::view
