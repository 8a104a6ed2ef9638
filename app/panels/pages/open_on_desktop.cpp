#include "app/panels/pages/open_on_desktop.h"

#include <cstdlib>
#include <string>

namespace insonate::ui {

std::future<bool> open_on_desktop(const std::filesystem::path& file) {
  std::string quoted = "'";
  for (const char c : std::filesystem::absolute(file).string()) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  // Some desktops let xdg-open wait until the program ends. One that has run for 2 s has found a program.
  const std::string command = "xdg-open " + quoted +
                              "' >/dev/null 2>&1 & opener=$!; for i in 1 2 3 4 5 6 7 8 9 10; do sleep 0.2; "
                              "kill -0 $opener 2>/dev/null || { wait $opener; exit; }; done";
  return std::async(std::launch::async, [command] { return std::system(command.c_str()) == 0; });
}

}  // namespace insonate::ui
