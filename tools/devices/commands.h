#pragma once

#include <functional>

#include "tools/cli/program.h"

/// The commands of insonate-devices, each in its own file. To add one, add a file, a line here and one in main.
namespace insonate::devices {

/// A command: its parser and its work.
struct Command {
  const CLI::App* parser;     ///< knows whether the command was given
  std::function<int()> work;  ///< called after parsing; returns the exit code
};

/// Each function adds its arguments to the program.
Command calibrate_command(CLI::App& program);
Command list_command(CLI::App& program);
Command bench_command(CLI::App& program);
Command check_command(CLI::App& program);
Command recover_command(CLI::App& program);
Command watch_command(CLI::App& program);

}  // namespace insonate::devices
