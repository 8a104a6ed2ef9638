#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "sim/core/image.h"
#include "sim/gl/objects.h"

namespace insonate::gl {

/// Brings grey pictures back from the device without waiting for it: what is asked for in one frame is there in one of
/// the next. Pixels go through buffers of the device, each behind a fence.
class Readback {
public:
  /// So many may be under way: a device that is slower than that has nothing to gain from more.
  static constexpr std::size_t kMost = 3;

  bool full() const { return under_way_.size() == kMost; }

  /// Starts to read the red channel of an 8-bit texture as it is now. Throws std::logic_error when full().
  void begin(const Texture& texture);

  /// The picture that was asked for first of those under way, once it is there. @param wait  for it, if there is any
  std::optional<Image<std::uint8_t>> take(bool wait = false);

  /// Gives up what is under way.
  void forget() { under_way_.clear(); }

private:
  /// A sign of the device that it has done everything asked of it before.
  class Fence {
  public:
    Fence() : sync_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {}
    Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
    Fence& operator=(Fence&&) = delete;
    ~Fence() { glDeleteSync(sync_); }
    bool passed(bool wait) const;

  private:
    GLsync sync_;
  };
  struct Transfer {
    int width, height;
    Buffer pixels;
    Fence fence;
  };
  std::deque<Transfer> under_way_;
};

}  // namespace insonate::gl
