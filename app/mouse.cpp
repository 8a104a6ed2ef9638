#include "app/mouse.h"

#include <cfloat>

namespace insonate {
namespace {

constexpr double kDoubleClick_s = 0.35;

}  // namespace

void Mouse::apply() {
  ImGuiIO& io = ImGui::GetIO();
  if (!events_.empty()) {
    const Button& next = events_.front();
    // The pointer moves there one frame earlier, so that nothing it passes over is dragged.
    const bool is_there = next.at.x == shown_at_.x && next.at.y == shown_at_.y;
    io.MousePos = next.at;
    if (is_there) {
      if (next.down) {
        // ImGui compares the time of the frames with this limit, so the limit decides.
        double& before_s = pressed_s_[std::size_t(next.number)];
        io.MouseDoubleClickTime = next.time_s - before_s < kDoubleClick_s ? FLT_MAX : 0;
        before_s = next.time_s;
      }
      down_[std::size_t(next.number)] = next.down;
      events_.pop_front();
    }
  }
  shown_at_ = io.MousePos;
  for (int button = 0; button < kButtons; ++button) io.MouseDown[button] = down_[std::size_t(button)];
}

}  // namespace insonate
