// insonate-devices: lists trackers, checks recorded logs, and shows a tracker's output.

#include <vector>

#include "tools/devices/commands.h"

using namespace insonate;

int main(int argc, char** argv) {
  CLI::App arguments("List, watch, record and calibrate trackers, and check recorded logs.", "insonate-devices");
  arguments.require_subcommand(1);
  arguments.footer(
      "Examples:\n"
      "  insonate-devices list\n"
      "  insonate-devices check scan.igs.mha --json\n"
      "  insonate-devices watch 'replay:scan.igs.mha?speed=4'\n"
      "  insonate-devices calibrate pivot --tracker hydra: --out lab.toml");
  const std::vector<devices::Command> commands = {
      devices::list_command(arguments),  devices::bench_command(arguments),   devices::calibrate_command(arguments),
      devices::check_command(arguments), devices::recover_command(arguments), devices::watch_command(arguments),
  };
  return run_program(arguments, argc, argv, [&] {
    for (const devices::Command& command : commands)
      if (command.parser->parsed()) return command.work();
    return 0;
  });
}
