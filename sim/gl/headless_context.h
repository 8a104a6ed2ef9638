#pragma once

#include <string>

namespace insonate::gl {

/// An OpenGL 4.5 core context without a window, current on the thread that made it until it is destroyed.
///
/// Made through EGL: Mesa's surfaceless platform first, then the first EGL device, which is how headless GPUs answer.
/// Throws std::runtime_error naming what is missing when neither gives such a context.
class HeadlessContext {
public:
  /// A debugged context tells of errors by KHR_debug, if it is asked to; drivers are slower for it.
  enum class Kind { ordinary, debugged };
  explicit HeadlessContext(Kind kind = Kind::ordinary);
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

/// The current context's renderer and version, for reports and benchmarks.
std::string device_description();

}  // namespace insonate::gl
