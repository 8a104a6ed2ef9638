#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace insonate {

/// The man page of a program (roff, section 1), made from the options and commands that it declares.
std::string man_page(const CLI::App& program);

/// The completion of a program's command line (a script for bash), made from the same.
std::string bash_completion(const CLI::App& program);

}  // namespace insonate
