#include "app/cursors.h"

#include <GLFW/glfw3.h>

#include <array>

namespace insonate {

Cursors::Cursors() {
  std::array<unsigned char, 4> transparent{};
  const GLFWimage pixel{1, 1, transparent.data()};
  shapes_ = {{ImGuiMouseCursor_None, glfwCreateCursor(&pixel, 0, 0)},
             {ImGuiMouseCursor_TextInput, glfwCreateStandardCursor(GLFW_IBEAM_CURSOR)},
             {ImGuiMouseCursor_Hand, glfwCreateStandardCursor(GLFW_HAND_CURSOR)}};
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange;  // ImGui's backend would hide it by GLFW
}

Cursors::~Cursors() {
  for (const auto& [shape, cursor] : shapes_) glfwDestroyCursor(cursor);
}

void Cursors::show(GLFWwindow* window) {
  const ImGuiMouseCursor asked = ImGui::GetMouseCursor();
  if (asked == shown_) return;
  shown_ = asked;
  const auto found = shapes_.find(asked);
  glfwSetCursor(window, found == shapes_.end() ? nullptr : found->second);
}

}  // namespace insonate
