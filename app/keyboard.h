#pragma once

#include <vector>

#include "app/panels/screen.h"
#include "app/trainer.h"

struct GLFWwindow;

namespace insonate {

/// A key that went down, as GLFW numbers it.
struct KeyPress {
  int key = 0;
  int modifiers = 0;
  bool repeated = false;
};

/// What keys do: those held move the probe as long as they are held, those pressed do something once.
class Keyboard {
public:
  explicit Keyboard(GLFWwindow* window) : window_(window) {}

  /// @param elapsed_s  since the last call
  /// Whether a key is held that moves the probe.
  bool apply(const std::vector<KeyPress>& pressed, Trainer& trainer, ui::Screen& screen, double elapsed_s);

private:
  bool held(int key) const;
  bool move_probe(Session& session, double elapsed_s) const;
  static void press(const KeyPress& press, Trainer& trainer, ui::Screen& screen);

  GLFWwindow* window_;
};

}  // namespace insonate
