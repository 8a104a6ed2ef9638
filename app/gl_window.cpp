#include "app/gl_window.h"

#include <epoxy/gl.h>
// After epoxy, which declares OpenGL.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <stdexcept>

namespace insonate {
namespace {

constexpr int kLeastWidth = 1024, kLeastHeight = 700;

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
  glfwSetWindowSizeLimits(window.get(), kLeastWidth, kLeastHeight, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwMakeContextCurrent(window.get());
  glfwSwapInterval(1);
  return window;
}

}  // namespace insonate
