#include "app/mouse.h"

namespace insonate {

void Mouse::apply() {
  ImGuiIO& io = ImGui::GetIO();
  if (!events_.empty()) {
    const Button& next = events_.front();
    // The pointer moves there one frame earlier, so that nothing it passes over is dragged.
    const bool is_there = next.at.x == shown_at_.x && next.at.y == shown_at_.y;
    io.MousePos = next.at;
    if (is_there) {
      down_[std::size_t(next.number)] = next.down;
      events_.pop_front();
    }
  }
  shown_at_ = io.MousePos;
  for (int button = 0; button < kButtons; ++button) io.MouseDown[button] = down_[std::size_t(button)];
}

}  // namespace insonate
