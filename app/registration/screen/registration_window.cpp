#include "app/registration/screen/registration_window.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/gl_window.h"
#include "app/mouse.h"
#include "app/panels/canvas.h"
#include "app/panels/widgets/theme.h"
#include "app/registration/live_session.h"
#include "app/registration/registration_pictures.h"
#include "app/registration/screen/registration_page.h"
#include "app/registration/screen/registration_state.h"
#include "devices/live/steady_clock.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/files/png.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/upload.h"
#include "sim/tissue/tissue.h"
#include "tools/cli/subject.h"

namespace insonate {
namespace {

constexpr double kFrame_s = 1.0 / 60;

struct ImGuiOwner {
  explicit ImGuiOwner(GLFWwindow* window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplGlfw_InitForOpenGL(window, false);
  }
  ~ImGuiOwner() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
};

/// What GLFW's callbacks note for the next frame.
struct Events {
  Mouse mouse;
  ImVec2 pointer;
  ui::RegistrationWish wish;
  bool exposed = true;
};

void listen(GLFWwindow* window, Events& events) {
  const auto of = [](GLFWwindow* w) -> Events& { return *static_cast<Events*>(glfwGetWindowUserPointer(w)); };
  static const auto events_of = of;
  glfwSetWindowUserPointer(window, &events);
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
    if (action != GLFW_PRESS) return;
    ui::RegistrationWish& wish = events_of(w).wish;
    if (key == GLFW_KEY_F) wish.refine = true;
    if (key == GLFW_KEY_W) wish.search = true;
    if (key == GLFW_KEY_BACKSPACE) wish.reset = true;
    if (key == GLFW_KEY_S) wish.save = true;
    if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(w, GLFW_TRUE);
  });
  glfwSetCursorPosCallback(
      window, [](GLFWwindow* w, double x, double y) { events_of(w).pointer = ImVec2(float(x), float(y)); });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    if (button < Mouse::kButtons)
      events_of(w).mouse.note({button, action == GLFW_PRESS, events_of(w).pointer, steady_now_s()});
  });
  glfwSetCursorEnterCallback(window, ImGui_ImplGlfw_CursorEnterCallback);
  glfwSetWindowFocusCallback(window, ImGui_ImplGlfw_WindowFocusCallback);
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { events_of(w).exposed = true; });
}

/// Runs the loop around the session.
class Loop {
public:
  Loop(GLFWwindow* window, const RegistrationOptions& options, LiveSession& session, RegistrationPictures& pictures)
      : window_(window),
        options_(options),
        session_(session),
        pictures_(pictures),
        imgui_(window),
        theme_(assets_folder() / "fonts") {
    listen(window, events_);
  }

  void run() {
    const double start_s = steady_now_s();
    while (!glfwWindowShouldClose(window_)) {
      const double now_s = steady_now_s();
      step(now_s);
      if (options_.seconds > 0 && now_s - start_s >= options_.seconds) break;
      const double left_s = kFrame_s - (steady_now_s() - now_s);
      if (left_s > 0.0005 && !events_.mouse.waiting())
        glfwWaitEventsTimeout(left_s);
      else
        glfwPollEvents();
    }
    if (!options_.screenshot.empty()) write_png(options_.screenshot, canvas_.read());
  }

private:
  void step(double now_s) {
    session_.update(now_s);
    session_.hold(holds_);
    if (pictures_.draw(session_)) drawn_s_.push_back(now_s);
    while (!drawn_s_.empty() && drawn_s_.front() < now_s - 1) drawn_s_.pop_front();
    const bool changed = draw(), exposed = std::exchange(events_.exposed, false);
    if (changed || exposed) presenter_.show(window_, canvas_, exposed);
    session_.hold(false);
    obey(std::exchange(events_.wish, {}));
    if (!options_.state_file.empty() && now_s - written_s_ > kStateEvery_s) {
      written_s_ = now_s;
      write_registration_state(options_.state_file, session_,
                               {pictures_.drawn(), double(drawn_s_.size()), page_.places()});
    }
  }

  bool draw() {
    ImGui_ImplGlfw_NewFrame();
    events_.mouse.apply();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    if (size.x <= 0 || size.y <= 0) return false;  // minimised
    if (theme_.fit(size.x, size.y) || !ImGui::GetIO().Fonts->TexID) canvas_.make_fonts();
    ImGui::NewFrame();
    const ui::RegistrationWish wish =
        page_.draw(theme_, {0, 0, size.x, size.y}, session_, pictures_, double(drawn_s_.size()), notice_);
    ImGui::Render();
    obey(wish);
    return canvas_.draw(*ImGui::GetDrawData(), ui::colour::kBackground, [this](ImTextureID texture) {
      const auto name = GLuint(reinterpret_cast<std::uintptr_t>(texture));
      const bool ours = name == pictures_.received().name() || name == pictures_.simulated().name() ||
                        name == pictures_.blended().name();
      return ours ? pictures_.drawn() : 0;
    });
  }

  void obey(const ui::RegistrationWish& wish) {
    if (wish.refine) session_.refine(!session_.refines());
    if (wish.search) session_.search_widely();
    if (wish.reset) session_.reset();
    if (!wish.save) return;
    try {
      notice_ = "Saved to " + session_.save(options_.out).string();
    } catch (const InputError& error) {
      notice_ = error.what();
    }
  }

  GLFWwindow* window_;
  const RegistrationOptions& options_;
  LiveSession& session_;
  RegistrationPictures& pictures_;
  ImGuiOwner imgui_;
  ui::Canvas canvas_;
  Presenter presenter_;
  ui::Theme theme_;
  ui::RegistrationPage page_;
  Events events_;
  std::deque<double> drawn_s_;  // times of the last second's pictures
  /// A graphics card does not know the priority of threads. Without one, that alone makes the registration give way.
  const bool holds_ = !gl::is_software_renderer();
  double written_s_ = -1;
  std::string notice_;
};

}  // namespace

int run_registration_window(const RegistrationOptions& options) {
  const LiveRequest request = options.request();
  const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
  std::printf("Loading the patient.\n");
  std::fflush(stdout);
  const Case subject = open_subject(request.subject);
  const AcousticVolume volume = make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table);
  LiveSession session(request, subject, volume);
  const GlfwLibrary library;
  const GlWindow window = open_gl_window("Insonate: registration", options.width, options.height);
  std::unique_ptr<RegistrationPictures> pictures;
  gl::upload_ct(request.subject, volume.grid,
                [&] { pictures = std::make_unique<RegistrationPictures>(volume, table); });
  Loop(window.get(), options, session, *pictures).run();
  return 0;
}

}  // namespace insonate
