#include <cstdio>

#include "app/headless.h"
#include "app/loading.h"
#include "app/options.h"
#include "app/window.h"
#include "sim/core/input_error.h"
#include "tools/program.h"

int main(int argc, char** argv) {
  using namespace insonate;
  CLI::App arguments("", "insonate");
  Options options;
  declare(arguments, options);
  const int exit_code = run_program(arguments, argc, argv, [&] {
    check(options);
    if (!options.headless && !has_display()) {
      if (options.mode == Mode::author || options.mode == Mode::setup)
        throw InputError("insonate", "", "this needs a window, and there is no display", "start it where there is one");
      std::printf("There is no display: the session runs without a window, and leaves its results in %s.\n",
                  options.out.string().c_str());
      options.headless = true;
    }
    return options.headless ? run_headless(options) : run_window(options);
  });
  return leave_program(exit_code);
}
