#include "app/full_screen.h"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace insonate {
namespace {

/// Returns how many pixels of the monitor a window covers.
long shared_pixels(GLFWmonitor* monitor, int x, int y, int width, int height) {
  int left = 0, top = 0;
  glfwGetMonitorPos(monitor, &left, &top);
  const GLFWvidmode* const mode = glfwGetVideoMode(monitor);
  if (!mode) return 0;
  const long wide = std::min(x + width, left + mode->width) - std::max(x, left);
  const long high = std::min(y + height, top + mode->height) - std::max(y, top);
  return std::max(wide, 0l) * std::max(high, 0l);
}

}  // namespace

void FullScreen::toggle(GLFWwindow* window) {
  if (glfwGetWindowMonitor(window))
    return glfwSetWindowMonitor(window, nullptr, x_, y_, width_, height_, GLFW_DONT_CARE);
  glfwGetWindowPos(window, &x_, &y_);
  glfwGetWindowSize(window, &width_, &height_);
  int count = 0;
  GLFWmonitor** const monitors = glfwGetMonitors(&count);
  GLFWmonitor** const best = std::max_element(monitors, monitors + count, [&](GLFWmonitor* a, GLFWmonitor* b) {
    return shared_pixels(a, x_, y_, width_, height_) < shared_pixels(b, x_, y_, width_, height_);
  });
  const GLFWvidmode* const mode = count > 0 ? glfwGetVideoMode(*best) : nullptr;
  if (mode) glfwSetWindowMonitor(window, *best, 0, 0, mode->width, mode->height, mode->refreshRate);
}

}  // namespace insonate
