#pragma once

#include <deque>
#include <map>
#include <set>

#include "app/full_screen.h"
#include "app/panels/screen.h"
#include "app/trainer/trainer.h"

struct GLFWwindow;

namespace insonate {

/// An event of a key, or a character that was typed.
struct KeyEvent {
  enum class Kind { pressed, repeated, released, typed };
  Kind kind = Kind::pressed;
  int key = 0;             ///< as GLFW numbers it; Keyboard::note() replaces letters' places by the letters
  int modifiers = 0;       ///< GLFW's bits
  unsigned character = 0;  ///< of what was typed, Unicode
  double time_s = 0;       ///< steady_now_s()
};

/// Gives keys their meaning: held keys move the probe, pressed keys act once, and typed characters go to the field that
/// is open. Events are handled in their order, however long a frame takes. Dear ImGui 1.86 reads keys once per frame
/// and would miss one that is released by then.
class Keyboard {
public:
  explicit Keyboard(GLFWwindow* window) : window_(window) {}

  /// Stores an event. GLFW's callbacks call it. GLFW numbers keys by their place on an American keyboard: a letter on
  /// another place of the person's keyboard counts as that letter.
  void note(KeyEvent event);

  /// Handles the events so far. Call it before each of ImGui's frames. Returns whether a held key moves the probe.
  /// @param elapsed_s  since the last call
  /// @param until_s    later events wait: no frame has seen the click before them yet
  bool apply(Trainer& trainer, ui::Screen& screen, double elapsed_s, double until_s);

  /// Returns whether events wait for the next frame.
  bool waiting() const { return !events_.empty(); }

private:
  bool held(int key) const;
  bool move_probe(Session& session, double elapsed_s) const;
  void dispatch(Trainer& trainer, ui::Screen& screen, double until_s);
  bool type(const KeyEvent& event, Trainer& trainer, ui::Screen& screen);
  void press(const KeyEvent& event, Trainer& trainer, ui::Screen& screen);
  bool open_page(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen);
  static void choose(int index, Trainer& trainer);
  static void start_page(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen);
  static void learners_page(const KeyEvent& pressed, LearnersPage& page, Trainer& trainer, ui::Screen& screen);
  static void check_page(const KeyEvent& pressed, CheckPage& page, Trainer& trainer, ui::Screen& screen);
  static bool change_views(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen);
  static void replay(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen);
  static void volume_page(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen);
  static void set_up(const KeyEvent& pressed, Trainer& trainer);

  GLFWwindow* window_;
  FullScreen full_screen_;
  std::deque<KeyEvent> events_;
  std::map<int, int> down_;     ///< keys that are down: by GLFW's number, what they count as
  std::set<int> tapped_;        ///< pressed since the last frame, even if up again
  bool field_is_busy_ = false;  ///< with a key that it has to see before the next one
};

}  // namespace insonate
