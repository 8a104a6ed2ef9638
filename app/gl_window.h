#pragma once

#include <memory>
#include <string>

struct GLFWwindow;

namespace insonate {
namespace ui {
class Canvas;
}

/// Holds GLFW while windows exist. Throws std::runtime_error without a display.
struct GlfwLibrary {
  GlfwLibrary();
  ~GlfwLibrary();
  GlfwLibrary(const GlfwLibrary&) = delete;
  GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

struct WindowDeleter {
  void operator()(GLFWwindow* window) const;
};
using GlWindow = std::unique_ptr<GLFWwindow, WindowDeleter>;

/// Opens a window with OpenGL 4.5, which is current then. It cannot be made smaller than the screens' panels need.
/// Throws std::runtime_error if the display has no such OpenGL.
/// @param width, height  in the units of GLFW's screen coordinates; on a smaller screen the window fills it
GlWindow open_gl_window(const std::string& title, int width, int height);

/// Shows a canvas in the window that is current.
class Presenter {
public:
  /// Shows the canvas whole, or only where its last draw() has drawn. A software renderer then copies only that; a
  /// graphics card swaps the whole window, at the display's own rate.
  void show(GLFWwindow* window, const ui::Canvas& canvas, bool whole);

private:
  int width_ = 0, height_ = 0;  ///< of the window when it was last shown whole, pixels
};

}  // namespace insonate
