#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "sim/core/image.h"
#include "sim/gl/objects.h"

namespace insonate::gl {

/// Reads grey pictures back from the device without blocking: a picture requested in one frame arrives during one of
/// the next. Pixels go through device buffers, each followed by a fence.
class Readback {
public:
  /// Most pictures in flight: a device that is slower than that gains nothing from more.
  static constexpr std::size_t kMax = 3;

  bool full() const { return under_way_.size() == kMax; }

  /// Starts to read the red channel of an 8-bit texture as it is now. Throws std::logic_error if full().
  void begin(const Texture& texture);

  /// Returns the oldest picture in flight once it has arrived; empty before, and if there is none. Throws
  /// std::runtime_error if the device does not report when it has finished.
  /// @param wait  blocks until the picture arrives
  std::optional<Image<std::uint8_t>> take(bool wait = false);

  /// Drops all pictures in flight.
  void forget() { under_way_.clear(); }

private:
  /// Signals when the device has done everything that was submitted before.
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
