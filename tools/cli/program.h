#pragma once

#include <CLI/CLI.hpp>
#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "tools/cli/about.h"
#include "tools/cli/program_pages.h"

namespace insonate {

/// Returns a value name for an option that checks its words itself. Help, the man page and completion list the words,
/// as they do for CLI::IsMember.
inline std::string one_of(const std::vector<std::string>& words) {
  return "NAME:" + CLI::detail::generate_set(words);
}

/// Sets HelpFormatter for a program and all of its commands.
inline void format_help_of(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormatter>());
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) format_help_of(*command);
}

/// Sets the form of `--help`. Adds `--version`, and the options that packaging uses: `--man-page` and
/// `--bash-completion`, which help does not show.
inline void add_self_descriptions(CLI::App& program, const std::function<std::vector<AboutLine>()>& more_about) {
  format_help_of(program);
  program.set_version_flag(
      "--version",
      [&program, more_about] {
        return version_text(program.get_name(), more_about ? more_about() : std::vector<AboutLine>{});
      },
      "Print the version, the commit and the build, and exit");
  const auto add_page = [&program](const std::string& flag, std::string (*page)(const CLI::App&)) {
    program.add_flag_callback(flag, [&program, page] { throw CLI::CallForVersion(page(program), 0); })->group("");
  };
  add_page("--man-page", man_page);
  add_page("--bash-completion", bash_completion);
}

/// Lets no option take more arguments than it asks for. Otherwise CLI11 gives options that may be repeated whatever
/// follows, even the program's own files.
inline void take_no_more_than_asked(CLI::App& arguments) {
  for (CLI::Option* option : arguments.get_options())
    if (!option->get_positional()) option->allow_extra_args(false);
  for (CLI::App* command : arguments.get_subcommands([](const CLI::App*) { return true; }))
    take_no_more_than_asked(*command);
}

/// Refuses values that CLI11 accepts: NaN, which passes every range check; infinity where there is no range; and an
/// empty text, which CLI11 treats as an omitted option.
inline void refuse_unusable(const CLI::App& arguments) {
  for (const CLI::Option* option : arguments.get_options())
    for (const std::string& given : option->results()) {
      if (given.empty())
        throw InputError(option->get_name(), "", "nothing is given behind it", "give a value or leave it out");
      const bool real = option->get_type_name().find("FLOAT") != std::string::npos;
      if (real && !std::isfinite(std::strtod(given.c_str(), nullptr)))
        throw InputError(option->get_name(), "", "'" + given + "' is not a finite number", "give one");
    }
  for (const CLI::App* command : arguments.get_subcommands()) refuse_unusable(*command);
}

/// Returns the first long option of the command line that neither the program nor a command of it has, as the problem
/// and the remedy of a sentence; empty if it has all. CLI11 reads the value of such an option for a file, and may
/// complain about that.
inline std::string unknown_option(const CLI::App& arguments, int argc, char** argv) {
  std::map<std::string, bool> known;  // whether they take a value
  const std::function<void(const CLI::App&)> gather = [&](const CLI::App& app) {
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames()) known["--" + name] = option->get_items_expected_max() > 0;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) gather(*command);
  };
  gather(arguments);
  for (int i = 1; i < argc && std::strcmp(argv[i], "--") != 0; ++i) {
    const std::string given = argv[i], name = given.substr(0, given.find('='));
    if (!name.starts_with("--")) continue;
    if (const auto found = known.find(name); found != known.end()) {
      if (found->second && name == given) ++i;  // its value may begin with -- too
      continue;
    }
    std::vector<std::string> names;
    for (const auto& [other, takes_value] : known) names.push_back(other);
    const auto similar = similar_name(name, names);
    return "it has no option '" + in_one_line(name) + "'" + (similar ? "; did you mean '" + *similar + "'?" : "");
  }
  return "";
}

/// Throws InputError if the output could not be written completely to standard output.
inline void finish_printing() {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  const std::string why = errno == 0 ? "" : std::string(" (") + std::strerror(errno) + ")";
  if (failed)
    throw InputError("standard output", "", "it cannot be written" + why, "make room, or send it to another file");
}

/// The common part of every command-line program's main. It parses the arguments, runs `work`, and prints errors as one
/// sentence to standard error. Exit codes: 0 for success, or the result of `work`; 2 for unusable input, including
/// wrong arguments and output that cannot be written; 3 for a failure that the input did not cause.
inline int run_program(CLI::App& arguments, int argc, char** argv, const std::function<int()>& work,
                       const std::function<std::vector<AboutLine>()>& more_about = {}) {
  add_self_descriptions(arguments, more_about);
  take_no_more_than_asked(arguments);
  // A file at its size limit then causes an error message, as a full disk does, instead of ending the program.
  signal(SIGXFSZ, SIG_IGN);
  try {
    try {
      arguments.parse(argc, argv);
      refuse_unusable(arguments);
      const int code = work();
      finish_printing();
      return code;
    } catch (const CLI::Success& asked) {  // help, the version and the pages
      arguments.exit(asked);
      finish_printing();
      return 0;
    }
  } catch (const CLI::ParseError& error) {
    std::string command = arguments.get_name(), problem = in_one_line(error.what());
    for (const CLI::App* mode : arguments.get_subcommands()) command += " " + mode->get_name();
    if (problem.ends_with('.')) problem.pop_back();
    const bool may_be_its_fault =
        dynamic_cast<const CLI::ExtrasError*>(&error) || dynamic_cast<const CLI::RequiredError*>(&error);
    if (may_be_its_fault)
      if (const std::string unknown = unknown_option(arguments, argc, argv); !unknown.empty()) problem = unknown;
    std::fprintf(stderr, "%s: command line: %s '%s --help'.\n", arguments.get_name().c_str(),
                 (problem + (problem.ends_with('?') ? " See" : "; see")).c_str(), command.c_str());
    return 2;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s: %s\n", arguments.get_name().c_str(), error.what());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: there is not enough memory; close other programs, or give it less to work on\n",
                 arguments.get_name().c_str());
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", arguments.get_name().c_str(), error.what());
    return 3;
  }
}

}  // namespace insonate
