#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/volume/case.h"

namespace insonate {

/// A phantom is made from a recipe: a TOML text that lists labels with their Hounsfield units and texture, shapes in
/// the order they displace each other, landmarks and views. `assets/phantoms/abdomen.toml` documents it key by key.

/// Progress from 0 to 1, called from one thread at a time, a hundred times at most.
using Progress = std::function<void(double share)>;

/// Makes a case from a recipe's text. `options` are added to the recipe's own [options] and override them
/// ("free_fluid" = "true", "aorta_diameter_mm" = "45"). The same text, options and seed give the same voxels, whatever
/// the number of threads. Throws InputError naming `recipe_name` and the line.
Case make_phantom(const std::string& recipe_name, const std::string& recipe_text,
                  const std::vector<std::pair<std::string, std::string>>& options = {}, const Progress& progress = {});

/// What is wrong with an option and what to do about it.
struct OptionProblem {
  std::string option;
  std::string problem;
  std::string remedy;
};

/// All of `options` that the recipe does not take. Throws InputError when the recipe itself cannot be read.
std::vector<OptionProblem> problems_with_options(const std::string& recipe_name, const std::string& recipe_text,
                                                 const std::vector<std::pair<std::string, std::string>>& options);

/// How many phantoms a cache keeps: those used last, about 100 MB each for the built-in one at 1 mm. The bundled exams
/// have ten patients between them.
inline constexpr std::size_t kKeptPhantoms = 16;

/// The same, kept under `cache` in a folder named after a digest of the recipe, the options and the maker's version. A
/// cached case whose files do not match the digests written beside them is thrown away and made again; a cache that
/// cannot be written costs that time whenever the case is asked for, and nothing else. A new one makes those go that
/// were not among the last kKeptPhantoms to be used, but none that another process reads.
Case cached_phantom(const std::filesystem::path& recipe,
                    const std::vector<std::pair<std::string, std::string>>& options, const std::filesystem::path& cache,
                    const Progress& progress = {});

}  // namespace insonate
