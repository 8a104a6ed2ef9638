#pragma once

struct GLFWwindow;

namespace insonate {

/// Lets a window fill the monitor that it is mostly on, and gives it its place and size back.
class FullScreen {
public:
  void toggle(GLFWwindow* window);

private:
  int x_ = 0, y_ = 0, width_ = 0, height_ = 0;  ///< of the window before
};

}  // namespace insonate
