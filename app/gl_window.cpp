#include "app/gl_window.h"

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <stdexcept>

#include "app/panels/canvas.h"
#include "sim/gl/headless_context.h"

namespace insonate {
namespace {

constexpr int kMinWidth = 1024, kMinHeight = 700;

/// Copies parts of the window's back buffer to the screen, by GLX's extension MESA_copy_sub_buffer. Its functions are
/// found at run time: the window may have been opened without X11, and X11's headers define words such as Status.
class PartialSwap {
public:
  /// Returns it for the context that is current; none where the extension is missing.
  static const PartialSwap* find() {
    static const PartialSwap found;
    return found.copy_ && found.display_ && found.drawable_ ? &found : nullptr;
  }
  /// Copies a box, in pixels from the bottom left.
  void copy(int x, int y, int width, int height) const { copy_(display_(), drawable_(), x, y, width, height); }

private:
  using Display = void;
  using Drawable = unsigned long;

  PartialSwap() {
    if (!glfwExtensionSupported("GLX_MESA_copy_sub_buffer")) return;
    display_ = reinterpret_cast<Display* (*)()>(glfwGetProcAddress("glXGetCurrentDisplay"));
    drawable_ = reinterpret_cast<Drawable (*)()>(glfwGetProcAddress("glXGetCurrentDrawable"));
    copy_ =
        reinterpret_cast<void (*)(Display*, Drawable, int, int, int, int)>(glfwGetProcAddress("glXCopySubBufferMESA"));
  }

  Display* (*display_)() = nullptr;
  Drawable (*drawable_)() = nullptr;
  void (*copy_)(Display*, Drawable, int x, int y, int width, int height) = nullptr;
};

}  // namespace

GlfwLibrary::GlfwLibrary() {
  if (!glfwInit()) throw std::runtime_error("there is no display to open a window on");
}

GlfwLibrary::~GlfwLibrary() {
  glfwTerminate();
}

void WindowDeleter::operator()(GLFWwindow* window) const {
  glfwDestroyWindow(window);
}

GlWindow open_gl_window(const std::string& title, int width, int height) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  int left = 0, top = 0, widest = width, highest = height;
  if (GLFWmonitor* const monitor = glfwGetPrimaryMonitor())
    glfwGetMonitorWorkarea(monitor, &left, &top, &widest, &highest);
  // The title bar takes some of the height. Maximised, a window fits with it.
  glfwWindowHint(GLFW_MAXIMIZED, widest < width || highest < height ? GLFW_TRUE : GLFW_FALSE);
  GlWindow window(
      glfwCreateWindow(std::min(width, widest), std::min(height, highest), title.c_str(), nullptr, nullptr));
  if (!window) throw std::runtime_error("no window with OpenGL 4.5 can be opened on this display");
  glfwSetWindowSizeLimits(window.get(), kMinWidth, kMinHeight, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwMakeContextCurrent(window.get());
  glfwSwapInterval(1);
  return window;
}

void Presenter::show(GLFWwindow* window, const ui::Canvas& canvas, bool whole) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  // The size of the back buffer changes with a swap alone, and a box beyond it would end the program: an error of X. So
  // the window must have had the canvas's size when it was last swapped, and still have it.
  const auto fits = [&] {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return width == canvas.width() && height == canvas.height();
  };
  const PartialSwap* const parts = gl::is_software_renderer() ? PartialSwap::find() : nullptr;
  if (parts && !whole && width_ == canvas.width() && height_ == canvas.height()) {
    for (const ui::PixelBox& box : canvas.drawn()) canvas.show(box);
    if (fits()) {
      for (const ui::PixelBox& box : canvas.drawn())
        parts->copy(box.x, canvas.height() - box.end_y, box.end_x - box.x, box.end_y - box.y);
      return;
    }
  }
  canvas.show();
  glfwSwapBuffers(window);
  width_ = fits() ? canvas.width() : 0;
  height_ = canvas.height();
}

}  // namespace insonate
