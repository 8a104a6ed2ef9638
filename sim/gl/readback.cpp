#include "sim/gl/readback.h"

#include <stdexcept>
#include <utility>

namespace insonate::gl {

bool Readback::Fence::passed(bool wait) const {
  constexpr GLuint64 kSecond_ns = 1'000'000'000;
  for (;;) {
    const GLenum state = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, wait ? kSecond_ns : 0);
    if (state == GL_WAIT_FAILED) throw std::runtime_error("the graphics card does not say when it is done");
    if (state != GL_TIMEOUT_EXPIRED) return true;
    if (!wait) return false;
  }
}

void Readback::begin(const Texture& texture) {
  if (full()) throw std::logic_error("too many pictures are being read back");
  const int width = texture.width(), height = texture.height();
  Buffer pixels(std::size_t(width) * std::size_t(height), nullptr);
  // Through a framebuffer, not from the texture: Mesa's drivers block when a texture is read into a buffer.
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  const Object<FramebufferKind> source(name);
  glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, texture.name(), 0);
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, name);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, pixels.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  under_way_.push_back({width, height, std::move(pixels), Fence()});
}

std::optional<Image<std::uint8_t>> Readback::take(bool wait) {
  if (under_way_.empty() || !under_way_.front().fence.passed(wait)) return std::nullopt;
  const Transfer done = std::move(under_way_.front());
  under_way_.pop_front();
  Image<std::uint8_t> picture(done.width, done.height);
  done.pixels.read(picture.pixels.data(), picture.pixels.size());
  return picture;
}

}  // namespace insonate::gl
