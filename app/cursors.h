#pragma once

#include <imgui.h>

#include <map>

struct GLFWcursor;
struct GLFWwindow;

namespace insonate {

/// The pointer's shapes, as ImGui asks for them. A hidden pointer is one without a pixel: told to hide the pointer,
/// GLFW 3.3 looks up where it is by then, takes that for told already and never reports it, and a click there would
/// count where the pointer was last seen. To be made and ended while the window is open.
class Cursors {
public:
  Cursors();
  ~Cursors();
  Cursors(const Cursors&) = delete;
  Cursors& operator=(const Cursors&) = delete;

  /// Shows what was asked for in the last frame.
  void show(GLFWwindow* window);

private:
  std::map<ImGuiMouseCursor, GLFWcursor*> shapes_;  ///< the arrow is not in it: it is the window's own
  ImGuiMouseCursor shown_ = ImGuiMouseCursor_Arrow;
};

}  // namespace insonate
