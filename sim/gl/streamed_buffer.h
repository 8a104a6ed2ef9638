#pragma once

#include <deque>
#include <memory>
#include <type_traits>

#include "sim/gl/objects.h"

namespace insonate::gl {

/// Bytes that the processor writes anew for every use, such as the parameters of a dispatch.
///
/// Each write goes to storage that the device no longer reads. OpenGL promises that a buffer can simply be overwritten,
/// but NVIDIA's driver 580 on an H100 lets an earlier dispatch see what was written after it: then all looks of a
/// compounded picture were the last one.
class StreamedBuffer {
public:
  static constexpr std::size_t kMaxStorages = 16;  ///< then a write waits for the device, a second at most

  /// Replaces all bytes. Throws DeviceRefused if the device has not enough memory.
  void write(const void* data, std::size_t bytes);

  /// Bind what was written last. At least one write must have come before.
  void bind_uniform(GLuint binding) const { used_.back().buffer.bind_uniform(binding); }
  void bind_storage(GLuint binding) const { used_.back().buffer.bind_storage(binding); }

  /// Returns how many storages there are.
  std::size_t storages() const { return used_.size(); }

private:
  struct DeleteSync {
    void operator()(GLsync sync) const { glDeleteSync(sync); }
  };
  struct Storage {
    Buffer buffer;
    std::size_t bytes = 0;
    std::unique_ptr<std::remove_pointer_t<GLsync>, DeleteSync> last_use;  // null for the last one
  };

  std::deque<Storage> used_;  // from the one that was written first to the one that was written last
};

}  // namespace insonate::gl
