// insonate-devices recover: completes a recording that a crash cut short.

#include <cstdio>
#include <memory>
#include <string>

#include "devices/record/recording_files.h"
#include "tools/devices/commands.h"

namespace insonate::devices {
namespace {

int recover(std::string file) {
  const std::string ending = working_file("").string();
  if (file.ends_with(ending)) file.resize(file.size() - ending.size());
  const std::size_t frames = recover_recording(file);
  std::printf("wrote %s with %zu frames\n", file.c_str(), frames);
  return 0;
}

}  // namespace

Command recover_command(CLI::App& program) {
  const auto file = std::make_shared<std::string>();
  CLI::App* parser = program.add_subcommand("recover", "Make a sequence file from a recording that a crash cut short");
  parser
      ->add_option("FILE", *file,
                   "Complete this recording, named by its final name or as its working file (FILE.recording)")
      ->type_name("FILE")
      ->required();
  return {parser, [file] { return recover(*file); }};
}

}  // namespace insonate::devices
