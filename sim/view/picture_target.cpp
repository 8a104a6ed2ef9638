#include "sim/view/picture_target.h"

namespace insonate::view {
namespace {

void set(GLenum capability, bool on) {
  if (on)
    glEnable(capability);
  else
    glDisable(capability);
}

}  // namespace

void PictureTarget::resize(int width, int height) {
  if (has_size(width, height)) return;
  texture = gl::Texture::make_picture(width, height, gl::Filter::linear);
  framebuffer = gl::Framebuffer(texture);
}

ScopedDrawTarget::ScopedDrawTarget(const gl::Framebuffer& target, int first_row, int end_row)
    : blend_(glIsEnabled(GL_BLEND)),
      depth_test_(glIsEnabled(GL_DEPTH_TEST)),
      cull_face_(glIsEnabled(GL_CULL_FACE)),
      scissor_test_(glIsEnabled(GL_SCISSOR_TEST)) {
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer_);
  glGetIntegerv(GL_VIEWPORT, viewport_);
  glGetIntegerv(GL_SCISSOR_BOX, scissor_);
  for (GLenum capability : {GL_BLEND, GL_DEPTH_TEST, GL_CULL_FACE}) glDisable(capability);
  target.bind();
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, first_row, target.width(), end_row - first_row);
}

ScopedDrawTarget::~ScopedDrawTarget() {
  glBindFramebuffer(GL_FRAMEBUFFER, GLuint(framebuffer_));
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  glScissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
  set(GL_BLEND, blend_);
  set(GL_DEPTH_TEST, depth_test_);
  set(GL_CULL_FACE, cull_face_);
  set(GL_SCISSOR_TEST, scissor_test_);
}

}  // namespace insonate::view
