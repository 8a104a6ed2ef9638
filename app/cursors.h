#pragma once

#include <imgui.h>

#include <map>

struct GLFWcursor;
struct GLFWwindow;

namespace insonate {

/// Shows the pointer shapes that ImGui asks for. The hidden pointer is a cursor with one transparent pixel, because
/// GLFW 3.3 mishandles hiding: it queries the pointer's position at that moment, treats it as reported, and never
/// reports it. A click there would then count at the last reported position. Create and destroy this object while the
/// window is open.
class Cursors {
public:
  Cursors();
  ~Cursors();
  Cursors(const Cursors&) = delete;
  Cursors& operator=(const Cursors&) = delete;

  /// Shows the shape that the last frame asked for.
  void show(GLFWwindow* window);

private:
  std::map<ImGuiMouseCursor, GLFWcursor*> shapes_;  ///< without the arrow, which is the window's default
  ImGuiMouseCursor shown_ = ImGuiMouseCursor_Arrow;
};

}  // namespace insonate
