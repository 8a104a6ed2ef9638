#include "app/panels/pages/open_on_desktop.h"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace insonate::ui {

void open_on_desktop(const std::filesystem::path& file) {
  std::string quoted = "'";
  for (const char c : std::filesystem::absolute(file).string()) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  const std::string command = "xdg-open " + quoted + "' >/dev/null 2>&1 &";
  if (std::system(command.c_str()) != 0) std::fprintf(stderr, "insonate: the desktop does not open files\n");
}

}  // namespace insonate::ui
