#include "tools/bench/paper_traversal.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "tools/bench/shaders.h"

namespace insonate::gl {
namespace {

constexpr double kLn10 = 2.302585092994046;

// Matches `Line` in paper_pass.frag.
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

PaperTraversal::PaperTraversal() : no_vertices_(created<VertexArrayKind>(glCreateVertexArrays)) {
  const ShaderSources sources = bench::shaders();
  for (std::size_t i = 0; i < passes_.size(); ++i)
    passes_[i] = Program(sources, {"paper_pass.vert", "paper_pass.frag"}, {{"SAMPLES_A_LENGTH", std::to_string(i)}});
}

void PaperTraversal::set_volume(const AcousticVolume& volume, const TissueTable& table) {
  volume_ = DeviceVolume(volume, table);
}

void PaperTraversal::set_lines(const ScanLines& lines, const Settings& settings) {
  lines_ = lines;
  settings_ = settings;
  const int n = int(lines.lines.size()), d = lines.samples;
  scan_ = Texture::make_2d(GL_RG32F, n, d, Filter::nearest);
  for (Side& side : sides_) {
    side.carried = Texture::make_2d(GL_RGBA32F, n, d, Filter::nearest);
    side.framebuffer = created<FramebufferKind>(glCreateFramebuffers);
    const GLuint name = side.framebuffer.name();
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, scan_.name(), 0);
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT1, side.carried.name(), 0);
    const GLenum targets[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(name, 2, targets);
  }
}

void PaperTraversal::run(const Pose& patient_from_probe) {
  const glm::dmat4 texture_from_probe = volume_.texture_from_patient() * patient_from_probe.matrix();
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
  const auto is = [&](double samples) { return std::abs(l / dr - samples) < 1e-9; };
  passes_[is(1) ? 1 : is(2) ? 2 : 0].use();
  glUniform1f(kRMin, float(lines_.r_min_mm));
  glUniform1f(kDr, float(dr));
  glUniform1f(kHalfLength, float(l / 2));
  glUniform1f(kExponent, float(dr / l));
  glUniform1f(kAbsorption, float(settings_.absorption ? settings_.frequency_mhz * dr / 100 * kLn10 : 0));
  glUniform1f(kGel, float(coupling_depth_mm(settings_)));
  glUniform1i(kSamples, lines_.samples);
  volume_.texture().bind(0);
  line_buffer_.bind_storage(0);
  volume_.tissue_lookup().bind(7);
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
