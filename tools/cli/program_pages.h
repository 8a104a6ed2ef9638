#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace insonate {

/// Returns the man page of a program (roff, section 1), generated from its declared options and commands.
std::string man_page(const CLI::App& program);

/// Returns the command-line completion of a program (a script for bash), generated from the same declarations.
std::string bash_completion(const CLI::App& program);

/// Formats the text of --help: each value by its name, and its conditions and default behind its description, as in the
/// man page.
class HelpFormatter : public CLI::Formatter {
public:
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

}  // namespace insonate
