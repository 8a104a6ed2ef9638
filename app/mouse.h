#pragma once

#include <imgui.h>

#include <array>
#include <deque>
#include <limits>

namespace insonate {

/// Passes the mouse buttons to ImGui: each press and release at the position where it was made and in a frame of its
/// own, however long frames take. Dear ImGui 1.86 reads the mouse once per frame. It would place a click where the
/// pointer has moved to since, and take two clicks for a double one by the times of their frames.
class Mouse {
public:
  struct Button {
    int number = 0;  ///< 0 left, 1 right, 2 middle
    bool down = false;
    ImVec2 at;
    double time_s = 0;  ///< steady_now_s()
  };
  static constexpr int kButtons = 3;

  /// Queues an event; to be called from GLFW's callback.
  void note(const Button& event) { events_.push_back(event); }

  /// To be called before each ImGui frame, once ImGui knows the current position of the pointer.
  void apply();

  /// Returns whether an event waits for the next frame.
  bool waiting() const { return !events_.empty(); }

  /// Returns the time of the oldest event that waits, steady_now_s(); infinity if none does.
  double waiting_since_s() const {
    return events_.empty() ? std::numeric_limits<double>::infinity() : events_.front().time_s;
  }

private:
  std::deque<Button> events_;
  std::array<bool, kButtons> down_{};
  std::array<double, kButtons> pressed_s_{};
  ImVec2 shown_at_{-1, -1};
};

}  // namespace insonate
