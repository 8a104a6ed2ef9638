#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/results/attempt.h"

namespace insonate {

/// Where they lie.
struct ResultFiles {
  std::filesystem::path report;      ///< HTML
  std::filesystem::path score;       ///< JSON (result_json.h)
  std::filesystem::path table;       ///< CSV (score_csv.h)
  std::filesystem::path statements;  ///< xAPI (xapi.h); empty for an attempt that is in no database

  std::vector<std::filesystem::path> all() const;
};

/// Writes what people and programs read of an attempt to a folder: report.html, score.json, score.csv, and
/// xapi.json when it is in a database. The same attempt gives the same bytes, at the end of the exam and out of the
/// database ever after. Throws InputError when the score cannot be read or the folder not be written to.
/// @param home_page  whose the learners' ids are, an IRL for xapi.json; empty: one that stands for the database
ResultFiles write_report_files(const std::filesystem::path& folder, const Attempt& attempt,
                               const std::string& home_page = {});

}  // namespace insonate
