#include <cstdio>

#include "app/headless.h"
#include "app/registration/registration_options.h"
#include "app/registration/screen/registration_headless.h"
#include "app/registration/screen/registration_window.h"
#include "app/session/loading.h"
#include "app/trainer/options.h"
#include "app/window.h"
#include "sim/core/input_error.h"
#include "sim/gl/headless_context.h"
#include "tools/cli/program.h"

namespace {

/// Describes the device that a session without a window would draw on. A window draws on the display's device.
std::vector<insonate::AboutLine> opengl_device() try {
  const insonate::gl::HeadlessContext context;
  return {{"OpenGL", insonate::gl::device_description()}};
} catch (const std::exception& error) {
  return {{"OpenGL", std::string("none, because ") + error.what()}};
}

}  // namespace

int main(int argc, char** argv) {
  using namespace insonate;
  CLI::App arguments("", "insonate");
  Options options;
  declare(arguments, options);
  RegistrationOptions registration;
  declare_registration(arguments, registration);
  const auto work = [&] {
    if (registration.chosen)
      return registration.headless || !has_display() ? run_registration_headless(registration)
                                                     : run_registration_window(registration);
    const bool no_display = !options.headless && !has_display();
    if (no_display && options.mode == Mode::check)
      throw InputError("command line", "check", "this mode needs a window, and there is no display",
                       "run insonate-score check instead");
    if (no_display && (options.mode == Mode::author || options.mode == Mode::setup))
      throw InputError("command line", options.mode == Mode::author ? "author" : "setup",
                       "this mode needs a window, and there is no display", "start it where there is one");
    options.headless = options.headless || no_display;
    check(options);
    if (no_display)
      std::printf("There is no display: the session runs without a window, and leaves its results in %s.\n",
                  options.out.string().c_str());
    return options.headless ? run_headless(options) : run_window(options);
  };
  const int exit_code = run_program(arguments, argc, argv, work, opengl_device);
  return leave_program(exit_code);
}
