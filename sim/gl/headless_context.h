#pragma once

#include <memory>
#include <string>

namespace insonate::gl {

/// An OpenGL 4.5 core context without a window, current on the thread that made it until it is destroyed.
///
/// Made through EGL, on a graphics card if one gives such a context, else on a software renderer; egl_displays() has
/// the order, and how to choose. Throws InputError for a choice that there is not, std::runtime_error naming what is
/// missing when nothing gives such a context.
class HeadlessContext {
public:
  /// A debugged context tells of errors by KHR_debug, if it is asked to; drivers are slower for it.
  enum class Kind { ordinary, debugged };
  explicit HeadlessContext(Kind kind = Kind::ordinary);
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

private:
  struct Current;
  std::unique_ptr<Current> current_;
};

/// The current context's renderer and version, for reports and benchmarks.
std::string device_description();

/// Whether the current context's renderer runs on the processor.
bool is_software_renderer();

}  // namespace insonate::gl
