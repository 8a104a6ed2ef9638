#include "app/keyboard.h"

#include <epoxy/gl.h>
// After epoxy, which brings OpenGL's declarations.
#include <GLFW/glfw3.h>

#include <algorithm>

namespace insonate {
namespace {

constexpr double kSlide_mm_s = 40, kPress_mm_s = 15, kTurn_deg_s = 40;
constexpr double kFine = 0.2;
/// A frame that took longer moves the probe no farther: nothing jumps after a pause.
constexpr double kLongestFrame_s = 0.1;

}  // namespace

bool Keyboard::held(int key) const {
  return glfwGetKey(window_, key) == GLFW_PRESS;
}

bool Keyboard::apply(const std::vector<KeyPress>& pressed, Trainer& trainer, ui::Screen& screen, double elapsed_s) {
  for (const KeyPress& key : pressed) press(key, trainer, screen);
  if (!trainer.session() || screen.takes_keys(trainer)) return false;
  return move_probe(*trainer.session(), std::min(elapsed_s, kLongestFrame_s));
}

bool Keyboard::move_probe(Session& session, double elapsed_s) const {
  if (held(GLFW_KEY_LEFT_CONTROL) || held(GLFW_KEY_RIGHT_CONTROL)) return false;
  const bool fine = held(GLFW_KEY_LEFT_SHIFT) || held(GLFW_KEY_RIGHT_SHIFT);
  const double amount = elapsed_s * (fine ? kFine : 1.0);
  const auto axis = [&](int plus, int minus) { return double(held(plus)) - double(held(minus)); };
  // The marker's side is on the left of the screen: the left arrow goes there.
  const glm::dvec2 slide =
      glm::dvec2(axis(GLFW_KEY_LEFT, GLFW_KEY_RIGHT), axis(GLFW_KEY_UP, GLFW_KEY_DOWN)) * kSlide_mm_s * amount;
  const double press_mm = axis(GLFW_KEY_PAGE_DOWN, GLFW_KEY_PAGE_UP) * kPress_mm_s * amount;
  const double tilt = axis(GLFW_KEY_D, GLFW_KEY_A), rotation = axis(GLFW_KEY_E, GLFW_KEY_Q),
               rock = axis(GLFW_KEY_W, GLFW_KEY_S);
  const bool slides = slide.x != 0 || slide.y != 0, turns = tilt != 0 || rotation != 0 || rock != 0;
  if (!slides && !turns && press_mm == 0) return false;
  session.move_probe([&](const ProbeHand& hand, const Pose& from) {
    Pose pose = from;
    if (slides) pose = hand.slide(pose, slide);
    if (press_mm != 0) pose = hand.press(pose, press_mm);
    const double turn = kTurn_deg_s * amount;
    return turns ? ProbeHand::turn(pose, tilt * turn, rotation * turn, rock * turn) : pose;
  });
  return true;
}

void Keyboard::press(const KeyPress& pressed, Trainer& trainer, ui::Screen& screen) {
  const std::string overlay = screen.overlay(trainer);
  if (pressed.key == GLFW_KEY_ESCAPE) return screen.dismiss();
  if (overlay == "problem") {
    if (pressed.key == GLFW_KEY_ENTER) trainer.problems().pop_front();
    return;
  }
  if (pressed.key == GLFW_KEY_F1) return screen.toggle_help();
  if (screen.takes_keys(trainer)) return;
  if (pressed.key == GLFW_KEY_SLASH && (pressed.modifiers & GLFW_MOD_SHIFT)) return screen.toggle_help();
  if (pressed.key == GLFW_KEY_O && (pressed.modifiers & GLFW_MOD_CONTROL)) return screen.ask_for_path();
  if (!trainer.session()) return;
  Session& session = *trainer.session();
  Console& console = session.console();
  switch (pressed.key) {
    case GLFW_KEY_TAB:
      if (!pressed.repeated)
        trainer.attempt(
            [&] { session.holder() == Holder::learner ? session.give_back_probe() : session.take_probe(); });
      break;
    case GLFW_KEY_SPACE:
      if (!pressed.repeated) console.frozen = !console.frozen;
      break;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD:
      console.gain_db = std::min(console.gain_db + 1, 30.0);
      break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      console.gain_db = std::max(console.gain_db - 1, -30.0);
      break;
    case GLFW_KEY_LEFT_BRACKET:
      console.depth_mm = std::max(console.depth_mm - 5, Console::kLeastDepth_mm);
      break;
    case GLFW_KEY_RIGHT_BRACKET:
      console.depth_mm = std::min(console.depth_mm + 5, Console::kMostDepth_mm);
      break;
    default:
      break;
  }
}

}  // namespace insonate
