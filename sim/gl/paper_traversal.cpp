#include "sim/gl/paper_traversal.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace insonate::gl {
namespace {

// As in shared/acoustic_volume.glsl.
constexpr int kFirstHu = -1024, kLookupSize = 4096;
constexpr double kLn10 = 2.302585092994046;

// As `Line` in paper_pass.frag.
struct GpuLine {
  glm::vec4 start, along, lateral, elevation;
};

// Locations of the uniforms in the shaders.
enum Uniform : GLint { kRMin, kDr, kHalfLength, kExponent, kAbsorption, kGel, kSamples };

template <typename Kind>
Object<Kind> created(void (*create)(GLsizei, GLuint*)) {
  GLuint name = 0;
  create(1, &name);
  return Object<Kind>(name);
}

}  // namespace

PaperTraversal::PaperTraversal(const ShaderSources& sources)
    : fetching_(sources, {"paper_pass.vert", "paper_pass.frag"}),
      carrying_(sources, {"paper_pass.vert", "paper_pass.frag"}, {{"CARRIES_IMPEDANCE", "1"}}),
      no_vertices_(created<VertexArrayKind>(glCreateVertexArrays)) {}

void PaperTraversal::set_volume(const AcousticVolume& volume, const TissueTable& table) {
  const glm::ivec3 size = volume.grid.size;
  volume_ = Texture::make_3d(GL_RG16_SNORM, size.x, size.y, size.z, Filter::linear, Wrap::border);
  const AcousticVoxel outside;
  volume_.set_border(float(outside.hu) / 32767.0f, float(outside.echogenicity_cdb) / 32767.0f, 0, 0);
  volume_.write(GL_RG, GL_SHORT, volume.voxels.data());
  // Voxel centres lie at (i + 1/2) / size in a texture.
  const glm::dmat4 scale = glm::scale(glm::dmat4(1.0), 1.0 / glm::dvec3(size));
  texture_from_patient_ = glm::translate(scale, glm::dvec3(0.5)) * glm::inverse(volume.grid.matrix());

  std::vector<glm::vec2> lookup;
  for (int i = 0; i < kLookupSize; ++i) {
    const TissueKnot knot = table.at(kFirstHu + i);
    lookup.emplace_back(knot.impedance_mrayl, knot.absorption_db_cm_mhz);
  }
  tissue_lookup_ = Buffer(lookup.size() * sizeof(glm::vec2), lookup.data());
}

void PaperTraversal::set_lines(const ScanLines& lines, const Settings& settings) {
  lines_ = lines;
  settings_ = settings;
  const int n = int(lines.lines.size()), d = lines.samples;
  line_buffer_ = Buffer(lines.lines.size() * sizeof(GpuLine), nullptr);
  scan_ = Texture::make_2d(GL_RG32F, n, d, Filter::nearest);
  for (Side& side : sides_) {
    side.carried = Texture::make_2d(GL_RG32F, n, d, Filter::nearest);
    side.framebuffer = created<FramebufferKind>(glCreateFramebuffers);
    const GLuint name = side.framebuffer.name();
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, scan_.name(), 0);
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT1, side.carried.name(), 0);
    const GLenum targets[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(name, 2, targets);
  }
}

void PaperTraversal::run(const Pose& patient_from_probe) {
  const glm::dmat4 texture_from_probe = texture_from_patient_ * patient_from_probe.matrix();
  const auto step = [&](const glm::dvec3& d) { return glm::vec4(texture_from_probe * glm::dvec4(d, 0)); };
  std::vector<GpuLine> placed;
  placed.reserve(lines_.lines.size());
  for (const ScanLine& line : lines_.lines) {
    const glm::dvec3 d = line.direction, lateral(d.y, -d.x, 0);
    placed.push_back({glm::vec4(texture_from_probe * glm::dvec4(line.start, 1)), step(d), step(lateral),
                      step(glm::cross(d, lateral))});
  }
  line_buffer_.write(placed.data(), placed.size() * sizeof(GpuLine));

  const double dr = lines_.dr_mm(), l = settings_.reflection_length_mm;
  (std::abs(l - dr) < 1e-9 * dr ? carrying_ : fetching_).use();
  glUniform1f(kRMin, float(lines_.r_min_mm));
  glUniform1f(kDr, float(dr));
  glUniform1f(kHalfLength, float(l / 2));
  glUniform1f(kExponent, float(dr / l));
  glUniform1f(kAbsorption, float(settings_.absorption ? settings_.frequency_mhz * dr / 100 * kLn10 : 0));
  glUniform1f(kGel, float(settings_.gel_mm));
  glUniform1i(kSamples, lines_.samples);
  volume_.bind(0);
  line_buffer_.bind_storage(0);
  tissue_lookup_.bind_storage(1);
  glBindVertexArray(no_vertices_.name());
  glViewport(0, 0, scan_.width(), scan_.height());
  for (int k = 0; k < lines_.samples; ++k) {
    const Side &to = sides_[std::size_t(k % 2)], &from = sides_[std::size_t((k + 1) % 2)];
    glBindFramebuffer(GL_FRAMEBUFFER, to.framebuffer.name());
    from.carried.bind(1);
    glDrawArrays(GL_LINES, 2 * k, 2);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glBindVertexArray(0);
}

PaperTraversal::Scan PaperTraversal::read() const {
  const int n = scan_.width(), d = scan_.height();
  std::vector<glm::vec2> values(std::size_t(n) * std::size_t(d));
  scan_.read(GL_RG, GL_FLOAT, values.data(), values.size() * sizeof(glm::vec2));
  Scan scan{Image<float>(n, d), Image<float>(n, d)};
  for (std::size_t i = 0; i < values.size(); ++i) {
    scan.intensity.pixels[i] = values[i].x;
    scan.reflection.pixels[i] = values[i].y;
  }
  return scan;
}

}  // namespace insonate::gl
