#include "app/window.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <optional>
#include <vector>

#include "app/cursors.h"
#include "app/gl_window.h"
#include "app/keyboard.h"
#include "app/mouse.h"
#include "app/panels/screen.h"
#include "app/pictures/frame_times.h"
#include "app/pictures/quality_governor.h"
#include "app/state_file.h"
#include "app/trainer/trainer.h"
#include "devices/live/steady_clock.h"
#include "sim/core/input_error.h"
#include "sim/files/png.h"
#include "sim/gl/headless_context.h"

namespace insonate {
namespace {

/// A higher frame rate would show nothing more.
constexpr double kFrame_s = 1.0 / 60;
/// While nothing changes, the screen still has clocks to update, and a tracker may begin to move.
constexpr double kIdle_s = 0.05;
/// How long any change keeps the screen at full frame rate.
constexpr double kLively_s = 0.4;
/// Time of the volume view in a frame that draws it, while the ultrasound moves and while it rests.
constexpr double kVolumeBudget_ms = 10, kVolumeBudgetAtRest_ms = 20;

/// Events from GLFW's callbacks, held for the next frame.
struct Events {
  explicit Events(GLFWwindow* window) : keyboard(window) {}
  bool any = false, exposed = true;
  Keyboard keyboard;
  Mouse mouse;
  ImVec2 pointer;
  std::vector<std::filesystem::path> dropped;
};

Events& events_of(GLFWwindow* window) {
  return *static_cast<Events*>(glfwGetWindowUserPointer(window));
}

KeyEvent::Kind kind_of(int action) {
  return action == GLFW_RELEASE  ? KeyEvent::Kind::released
         : action == GLFW_REPEAT ? KeyEvent::Kind::repeated
                                 : KeyEvent::Kind::pressed;
}

void listen(GLFWwindow* window, Events& events) {
  glfwSetWindowUserPointer(window, &events);
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int mods) {
    events_of(w).any = true;
    if (key != GLFW_KEY_UNKNOWN) events_of(w).keyboard.note({kind_of(action), key, mods, 0, steady_now_s()});
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned character) {
    events_of(w).any = true;
    events_of(w).keyboard.note({KeyEvent::Kind::typed, GLFW_KEY_UNKNOWN, 0, character, steady_now_s()});
  });
  // GLFW returns the current position of the pointer, not that at an event.
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    events_of(w).any = true;
    events_of(w).pointer = ImVec2(float(x), float(y));
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    events_of(w).any = true;
    if (button < Mouse::kButtons)
      events_of(w).mouse.note({button, action == GLFW_PRESS, events_of(w).pointer, steady_now_s()});
  });
  // These events go to ImGui unchanged.
  glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
    events_of(w).any = true;
    ImGui_ImplGlfw_ScrollCallback(w, x, y);
  });
  glfwSetCursorEnterCallback(window, ImGui_ImplGlfw_CursorEnterCallback);
  glfwSetWindowFocusCallback(window, ImGui_ImplGlfw_WindowFocusCallback);
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { events_of(w).any = true; });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { events_of(w).any = events_of(w).exposed = true; });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    events_of(w).any = true;
    for (int i = 0; i < count; ++i) events_of(w).dropped.emplace_back(paths[i]);
  });
}

/// Counts the pictures of the last second.
class PictureRate {
public:
  void see(double now_s, bool new_picture) {
    if (new_picture) pictures_s_.push_back(now_s);
    while (!pictures_s_.empty() && pictures_s_.front() < now_s - 1) pictures_s_.pop_front();
  }
  /// Returns pictures per second; 0 while the picture stands still.
  double value() const {
    if (pictures_s_.size() < 2) return 0;
    return double(pictures_s_.size() - 1) / (pictures_s_.back() - pictures_s_.front());
  }

private:
  std::deque<double> pictures_s_;
};

/// The person's own preferences, and what is wrong with them.
struct OwnPreferences {
  Preferences preferences;
  std::filesystem::path file;  ///< empty: they cannot be stored
  std::string problem;
};

OwnPreferences own_preferences() {
  OwnPreferences own;
  try {
    const std::filesystem::path file = preferences_file();
    own.preferences = read_preferences(file);
    own.file = file;
  } catch (const InputError& error) {
    own.problem = error.what();  // and the file stays as it is
  }
  return own;
}

/// Runs the loop around the trainer: at full frame rate while something changes, rarely otherwise. The screen is drawn
/// only where it changes.
class Loop {
public:
  Loop(GLFWwindow* window, const Options& options, const OwnPreferences& own)
      : window_(window),
        options_(options),
        trainer_(with_preferences(options, own.preferences), own.preferences, own.file),
        events_(window) {
    if (!own.problem.empty()) trainer_.problems().push_back(own.problem);
    if (!options.frame_times.empty()) {
      times_.emplace(options.frame_parts);
      trainer_.pictures().measure(*times_);
    }
    ImGui_ImplGlfw_InitForOpenGL(window, false);
    listen(window, events_);
    trainer_.open_from_options();
    start_s_ = last_s_ = steady_now_s();
  }
  ~Loop() { ImGui_ImplGlfw_Shutdown(); }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// Returns the exit code.
  int run() {
    while (!trainer_.is_over() && !screen_.quits()) {
      wait();
      const double now_s = steady_now_s();
      step(now_s);
      if (options_.seconds > 0 && now_s - start_s_ >= options_.seconds) break;
    }
    trainer_.hand_in_exam();
    trainer_.keep_look();
    trainer_.finish_recording();
    if (!options_.latency.empty()) trainer_.latency().write(options_.latency);
    if (times_) times_->write(options_.frame_times);
    if (!options_.screenshot.empty()) {
      governor_ = QualityGovernor();  // full resolution
      draw();
      write_png(options_.screenshot, screen_.read());
    }
    // No further frame will show them.
    for (const std::string& problem : trainer_.problems()) std::fprintf(stderr, "insonate: %s\n", problem.c_str());
    return trainer_.problems().empty() ? 0 : 2;
  }

private:
  void wait() {
    const double since_s = steady_now_s() - last_s_;
    const bool lively = steady_now_s() - changed_s_ < kLively_s;
    const double left_s = (lively ? kFrame_s : kIdle_s) - since_s;
    if (left_s > 0.0005 && !events_.any && !events_.keyboard.waiting() && !events_.mouse.waiting())
      glfwWaitEventsTimeout(left_s);
    else
      glfwPollEvents();
  }

  void step(double now_s) {
    const bool touched = std::exchange(events_.any, false);
    if (times_) times_->begin(now_s);
    open_dropped();
    if (glfwWindowShouldClose(window_)) {
      glfwSetWindowShouldClose(window_, GLFW_FALSE);
      screen_.quit(trainer_);
    }
    const bool moved = events_.keyboard.apply(trainer_, screen_, now_s - last_s_, events_.mouse.waiting_since_s());
    last_s_ = now_s;

    trainer_.update(now_s);
    if (trainer_.session() && trainer_.session()->take_go_on()) screen_.go_on(trainer_);
    if (times_) times_->end(FramePart::session);
    const Pictures& pictures = trainer_.pictures();
    const long drawn_before = pictures.drawn(), runs_before = pictures.simulator_runs(),
               version_before = pictures.ultrasound_version();
    const bool changed = draw();
    // The window's own picture may be lost while it is covered.
    const bool exposed = std::exchange(events_.exposed, false);
    if (changed || exposed) show(exposed);
    ++frames_;
    const bool new_picture = pictures.ultrasound_version() != version_before;
    if (touched || moved || pictures.drawn() != drawn_before || trainer_.loading() || trainer_.setup() ||
        (trainer_.learners_page() && trainer_.learners_page()->reading() > 0) ||
        (trainer_.check_page() && trainer_.check_page()->progress()))
      changed_s_ = now_s;
    governor_.see(now_s, steady_now_s() - now_s, pictures.simulator_runs() != runs_before);
    rate_.see(now_s, new_picture);
    if (now_s - rate_shown_s_ > 0.5) {
      rate_shown_s_ = now_s;
      screen_.set_pictures_per_second(rate_.value());
    }
    if (times_)
      times_->finish(steady_now_s(), {new_picture, changed, screen_.pixels_drawn(), governor_.quality(),
                                      pictures.volumes_drawn(), pictures.volume_scale()});
    if (trainer_.best_frame_due()) trainer_.keep_best_frame();
    trainer_.write_results_if_due();
    if (!options_.state_file.empty() && now_s - state_written_s_ > 0.1) {
      state_written_s_ = now_s;
      write_state(options_.state_file, trainer_, screen_, frames_, shown_, governor_.quality());
    }
  }

  void open_dropped() {
    const std::vector<std::filesystem::path> dropped = std::exchange(events_.dropped, {});
    if (dropped.size() == 1) screen_.open(dropped.front(), trainer_);
    if (dropped.size() > 1)
      trainer_.problems().push_back(std::to_string(dropped.size()) +
                                    " things were dropped; drop one at a time, a DICOM series as its folder.");
  }

  /// Returns whether the screen looks different now.
  bool draw() {
    cursors_.show(window_);
    ImGui_ImplGlfw_NewFrame();
    events_.mouse.apply();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    if (size.x <= 0 || size.y <= 0) return false;  // minimised
    trainer_.draw(screen_.picture_sizes(trainer_, size.x, size.y),
                  {governor_.quality(), governor_.moves() ? kVolumeBudget_ms : kVolumeBudgetAtRest_ms,
                   governor_.frames_per_turn()});
    return screen_.render(trainer_, times_ ? &*times_ : nullptr);
  }

  void show(bool whole) {
    presenter_.show(window_, screen_.canvas(), whole);
    ++shown_;
    if (times_) times_->end(FramePart::present);
  }

  GLFWwindow* window_;
  Options options_;
  Trainer trainer_;
  ui::Screen screen_;
  Presenter presenter_;
  Events events_;
  Cursors cursors_;
  QualityGovernor governor_{gl::is_software_renderer()};
  PictureRate rate_;
  std::optional<FrameTimes> times_;
  double start_s_ = 0, last_s_ = 0, changed_s_ = 0, state_written_s_ = -1, rate_shown_s_ = -1;
  long frames_ = 0, shown_ = 0;  ///< laid out, and of these shown
};

}  // namespace

bool has_display() {
  // The connection stays open until run_window ends. A bare X server resets when its last client leaves, and would
  // refuse the next one.
  return glfwInit() == GLFW_TRUE;
}

int run_window(const Options& options) {
  const GlfwLibrary library;
  const GlWindow window = open_gl_window("Insonate", options.width, options.height);
  return Loop(window.get(), options, own_preferences()).run();
}

}  // namespace insonate
