#pragma once

#include <imgui.h>

#include <array>
#include <deque>

namespace insonate {

/// The mouse's buttons as ImGui is to see them: each press and release where it was made and in a frame of its own,
/// however long frames take. Dear ImGui 1.86 looks at the mouse once a frame, and would take a click for one where the
/// pointer has got to since.
class Mouse {
public:
  struct Button {
    int number = 0;  ///< 0 left, 1 right, 2 middle
    bool down = false;
    ImVec2 at;
  };
  static constexpr int kButtons = 3;

  /// From GLFW's callback.
  void note(const Button& event) { events_.push_back(event); }

  /// To be called before each of ImGui's frames, when ImGui knows where the pointer now is.
  void apply();

  /// Whether something waits for the next frame.
  bool waiting() const { return !events_.empty(); }

private:
  std::deque<Button> events_;
  std::array<bool, kButtons> down_{};
  ImVec2 shown_at_{-1, -1};
};

}  // namespace insonate
