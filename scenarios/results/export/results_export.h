#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/results/database/results_database.h"

namespace insonate {

/// The outcome of export_results().
struct ExportedResults {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> problems;  ///< a sentence for each attempt whose score cannot be read
};

/// Writes everything that people compare to a new folder: learners.csv, attempts.csv, scores.csv and comments.csv
/// (docs/results.md has the columns). The folder appears completely or not at all. An attempt whose score cannot be
/// read has only what the database's own columns hold, and no rows in scores.csv. Throws InputError if something of the
/// folder's name is there, or if it cannot be written.
ExportedResults export_results(ResultsDatabase& database, const std::filesystem::path& folder);

}  // namespace insonate
