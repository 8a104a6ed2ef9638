#pragma once

#include <functional>

#include "app/panels/canvas.h"

struct GLFWwindow;

namespace insonate {

/// Shows a drawn frame in a window. A software renderer sends the window's pixels to the X server by itself, which for
/// a whole window takes as long as a view: where the driver offers it, only what has changed is sent
/// (GLX_MESA_copy_sub_buffer). A graphics card swaps its buffers.
class Presenter {
public:
  /// Needs the window's OpenGL context, current.
  explicit Presenter(GLFWwindow* window);

  /// @param whole  the window's own picture may be lost, or has never been shown
  void present(const ui::Canvas& canvas, bool whole) const;

private:
  GLFWwindow* window_;
  /// Shows a part of the back buffer: left and lower edge, width and height, pixels. Empty where the driver cannot.
  std::function<void(int, int, int, int)> copy_part_;
};

}  // namespace insonate
