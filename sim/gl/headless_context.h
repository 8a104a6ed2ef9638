#pragma once

#include <memory>
#include <string>

namespace insonate::gl {

/// Provides an OpenGL 4.5 core context without a window. It is current on the thread that created it until destruction.
///
/// EGL creates the context, on a graphics card if one gives such a context, otherwise on a software renderer.
/// egl_displays() describes the order and how to choose. The constructor throws InputError if the chosen device does
/// not exist. If no device gives such a context, it throws std::runtime_error that names what is missing.
class HeadlessContext {
public:
  /// A debugged context can report errors by KHR_debug, and makes drivers slower.
  enum class Kind { ordinary, debugged };
  explicit HeadlessContext(Kind kind = Kind::ordinary);
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

private:
  struct Current;
  std::unique_ptr<Current> current_;
};

/// Returns the current context's renderer and version, for reports and benchmarks.
std::string device_description();

/// Returns true if the current context's renderer runs on the processor.
bool is_software_renderer();

}  // namespace insonate::gl
