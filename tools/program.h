#pragma once

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <functional>

#include "sim/core/input_error.h"

namespace insonate {

/// What every command-line program's main does around its work: parses the arguments, runs `work`, and turns what
/// goes wrong into one sentence on standard error. Exit codes: 0 done, what `work` returns, 2 for input that cannot be
/// used (wrong arguments too), 3 for a failure that is not the input's.
inline int run_program(CLI::App& arguments, int argc, char** argv, const std::function<int()>& work) {
  try {
    arguments.parse(argc, argv);
    return work();
  } catch (const CLI::ParseError& error) {
    return arguments.exit(error) == 0 ? 0 : 2;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s: %s\n", arguments.get_name().c_str(), error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", arguments.get_name().c_str(), error.what());
    return 3;
  }
}

}  // namespace insonate
