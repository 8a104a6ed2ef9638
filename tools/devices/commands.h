#pragma once

#include <functional>

#include "tools/cli/program.h"

/// The commands of insonate-devices, each in a file of its own. A new one is a file, a line here and one in main.
namespace insonate::devices {

struct Command {
  const CLI::App* parser;     ///< tells whether the command was given
  std::function<int()> work;  ///< after the arguments have been parsed; returns the exit code
};

/// Each adds its arguments to the program's.
Command calibrate_command(CLI::App& program);
Command list_command(CLI::App& program);
Command bench_command(CLI::App& program);
Command check_command(CLI::App& program);
Command recover_command(CLI::App& program);
Command watch_command(CLI::App& program);

}  // namespace insonate::devices
