#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>

#include "app/registration/live_session.h"
#include "tools/register/sweep_options.h"

namespace insonate {

/// The command line of `insonate register`. It is a mode of its own: no exam has it.
struct RegistrationOptions {
  bool chosen = false;  ///< the command line names the mode
  std::string tracker, subject;
  SweepOptions sweep;
  RegistrationSettings settings;
  bool refines = true;
  std::filesystem::path out = "registration";  ///< the folder that is written; or the next free name
  bool headless = false;
  double seconds = 0;  ///< end after so many seconds; 0: headless after 300, in a window never
  std::filesystem::path screenshot, state_file;
  int width = 1280, height = 800;

  /// Returns what a session is begun with. Throws InputError.
  LiveRequest request() const;
};

/// Declares the mode `register`. Parsing fills in `options`.
void declare_registration(CLI::App& arguments, RegistrationOptions& options);

}  // namespace insonate
