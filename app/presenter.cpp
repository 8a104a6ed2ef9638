#include "app/presenter.h"

#include <epoxy/gl.h>
// After epoxy, which declares OpenGL.
#include <GLFW/glfw3.h>

#include <cstddef>
#include <vector>

#include "sim/gl/headless_context.h"

namespace insonate {
namespace {

/// A part has its own message to the X server, so more of them cost more than they save.
constexpr std::size_t kMostParts = 3;

/// GLX, as far as it is used. Its own headers come with Xlib, whose macros would be everywhere.
struct Glx {
  using Current = void* (*)();
  using CurrentDrawable = unsigned long (*)();
  using CopyPart = void (*)(void* display, unsigned long drawable, int x, int y, int width, int height);

  Current display = reinterpret_cast<Current>(glfwGetProcAddress("glXGetCurrentDisplay"));
  CurrentDrawable drawable = reinterpret_cast<CurrentDrawable>(glfwGetProcAddress("glXGetCurrentDrawable"));
  CopyPart copy_part = reinterpret_cast<CopyPart>(glfwGetProcAddress("glXCopySubBufferMESA"));
};

}  // namespace

Presenter::Presenter(GLFWwindow* window) : window_(window) {
  if (!gl::is_software_renderer() || !glfwExtensionSupported("GLX_MESA_copy_sub_buffer")) return;
  const Glx glx;
  if (!glx.display || !glx.drawable || !glx.copy_part) return;
  copy_part_ = [glx](int x, int y, int width, int height) {
    glx.copy_part(glx.display(), glx.drawable(), x, y, width, height);
  };
}

void Presenter::present(const ui::Canvas& canvas, bool whole) const {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  if (whole || !copy_part_) {
    canvas.show();
    return glfwSwapBuffers(window_);
  }
  const std::vector<ui::PixelBox> parts = ui::merged(canvas.changed(), kMostParts);
  for (const ui::PixelBox& part : parts) canvas.show(part);
  for (const ui::PixelBox& part : parts)
    copy_part_(part.x, canvas.height() - part.end_y, part.end_x - part.x, part.end_y - part.y);
}

}  // namespace insonate
