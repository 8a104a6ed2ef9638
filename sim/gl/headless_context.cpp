#include "sim/gl/headless_context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "sim/gl/egl_displays.h"

namespace insonate::gl {
namespace {

std::string text_of(GLenum name) {
  return reinterpret_cast<const char*>(glGetString(name));
}

EGLContext new_context(EGLDisplay display, HeadlessContext::Kind kind) {
  const EGLint debugged = kind == HeadlessContext::Kind::debugged;
  const std::array<EGLint, 9> wanted = {EGL_CONTEXT_MAJOR_VERSION,
                                        4,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        5,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_CONTEXT_OPENGL_DEBUG,
                                        debugged,
                                        EGL_NONE};
  return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted.data());
}

}  // namespace

/// A display and its current context; `context` is null if the display gives none.
struct HeadlessContext::Current {
  EGLDisplay display = EGL_NO_DISPLAY;  ///< initialised, or EGL_NO_DISPLAY
  EGLContext context = EGL_NO_CONTEXT;

  Current(EGLDisplay opened, Kind kind) {
    EGLint major = 0, minor = 0;
    if (opened == EGL_NO_DISPLAY || !eglInitialize(opened, &major, &minor)) return;
    display = opened;
    eglBindAPI(EGL_OPENGL_API);
    context = new_context(display, kind);
    if (context && make_current()) return;
    if (context) eglDestroyContext(display, context);
    context = EGL_NO_CONTEXT;
  }
  ~Current() {
    if (context) {
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      eglDestroyContext(display, context);
    }
    if (display) eglTerminate(display);
  }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

  bool make_current() const { return eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context); }
};

HeadlessContext::HeadlessContext(Kind kind) {
  bool any_display = false;
  for (const EglDisplay& display : egl_displays()) {
    if (current_ && display.is_software) break;  // cannot be better than the one found
    auto tried = std::make_unique<Current>(display.open(), kind);
    any_display |= tried->display != EGL_NO_DISPLAY;
    if (!tried->context) continue;
    const bool software = is_software_renderer();
    if (!current_ || !software) current_ = std::move(tried);
    if (!software) break;
  }
  if (!any_display)
    throw std::runtime_error("no EGL display without a window: install libegl1 and a driver (Mesa's will do)");
  if (!current_ || !current_->make_current())  // an attempt after it may have replaced it as the current context
    throw std::runtime_error(
        "the graphics driver gives no OpenGL 4.5 core context: update it, or use Mesa's software one");
}

HeadlessContext::~HeadlessContext() = default;

std::string device_description() {
  return text_of(GL_RENDERER) + ", OpenGL " + text_of(GL_VERSION);
}

bool is_software_renderer() {
  const std::string renderer = text_of(GL_RENDERER);
  constexpr std::array<const char*, 5> kNames = {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer"};
  return std::ranges::any_of(kNames, [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

}  // namespace insonate::gl
