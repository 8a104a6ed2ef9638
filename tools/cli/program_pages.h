#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace insonate {

/// Returns the man page of a program (roff, section 1), generated from its declared options and commands.
std::string man_page(const CLI::App& program);

/// Returns the command-line completion of a program (a script for bash), generated from the same declarations.
std::string bash_completion(const CLI::App& program);

}  // namespace insonate
