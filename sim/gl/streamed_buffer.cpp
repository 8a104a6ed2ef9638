#include "sim/gl/streamed_buffer.h"

#include <utility>

namespace insonate::gl {
namespace {

// Returns whether the device has come past the fence, after at most `wait_ns`.
bool is_past(GLsync fence, GLuint64 wait_ns) {
  const GLenum status = glClientWaitSync(fence, wait_ns > 0 ? GL_SYNC_FLUSH_COMMANDS_BIT : 0, wait_ns);
  return status == GL_ALREADY_SIGNALED || status == GL_CONDITION_SATISFIED;
}

}  // namespace

void StreamedBuffer::write(const void* data, std::size_t bytes) {
  constexpr GLuint64 kLong_ns = 1'000'000'000;
  if (!used_.empty()) used_.back().last_use.reset(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  Storage next;
  if (!used_.empty() && is_past(used_.front().last_use.get(), used_.size() < kMaxStorages ? 0 : kLong_ns)) {
    next = std::move(used_.front());
    used_.pop_front();
  }
  if (next.bytes < bytes)
    next = {Buffer(bytes, data), bytes, nullptr};
  else
    next.buffer.write(data, bytes);
  next.last_use.reset();
  used_.push_back(std::move(next));
}

}  // namespace insonate::gl
