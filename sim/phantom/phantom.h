#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/volume/case.h"

namespace insonate {

/// A phantom is made from a recipe. A recipe is a TOML text that lists labels with their Hounsfield units and texture,
/// shapes in the order in which they displace each other, landmarks and views. `assets/phantoms/abdomen.toml` documents
/// each key.

/// Receives progress from 0 to 1. Called from one thread at a time, at most a hundred times.
using Progress = std::function<void(double share)>;

/// Makes a case from a recipe's text. `options` override the recipe's own [options] ("free_fluid" = "true",
/// "aorta_diameter_mm" = "45"). The same text, options and seed give the same voxels, with any number of threads.
/// Throws InputError that names `recipe_name` and the line.
Case make_phantom(const std::string& recipe_name, const std::string& recipe_text,
                  const std::vector<std::pair<std::string, std::string>>& options = {}, const Progress& progress = {});

/// States what is wrong with an option and what to do about it.
struct OptionProblem {
  std::string option;
  std::string problem;
  std::string remedy;
};

/// Returns a problem for each of `options` that the recipe does not accept. Throws InputError if the recipe itself
/// cannot be read.
std::vector<OptionProblem> problems_with_options(const std::string& recipe_name, const std::string& recipe_text,
                                                 const std::vector<std::pair<std::string, std::string>>& options);

/// How many phantoms a cache keeps: the most recently used ones, about 100 MB each for the built-in one at 1 mm. The
/// bundled exams have ten different patients.
inline constexpr std::size_t kKeptPhantoms = 16;

/// Returns the same case as make_phantom() and stores it under `cache`, in a folder named after a digest of the recipe,
/// the options and the maker's version. A cached case whose files do not match the digests stored beside them is
/// discarded and made again. If the cache cannot be written, every call makes the case again. Storing a new case
/// removes those that are not among the `kept` most recently used, except any that another process is reading.
/// Throws InputError.
Case cached_phantom(const std::filesystem::path& recipe,
                    const std::vector<std::pair<std::string, std::string>>& options, const std::filesystem::path& cache,
                    const Progress& progress = {}, std::size_t kept = kKeptPhantoms);

}  // namespace insonate
