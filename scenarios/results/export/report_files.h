#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/results/attempt.h"

namespace insonate {

/// The paths of an attempt's report files.
struct ResultFiles {
  std::filesystem::path report;      ///< HTML
  std::filesystem::path score;       ///< JSON (result_json.h)
  std::filesystem::path table;       ///< CSV (score_csv.h)
  std::filesystem::path statements;  ///< xAPI (xapi.h); empty for an attempt that is not in a database

  std::vector<std::filesystem::path> all() const;
};

/// Returns the folder for the report of one attempt: FOLDER/attempts/2026-11-24T21-57-03Z_aorta_12, by its end in UTC,
/// the scenario's name and its number in the database. It is the same each time, so that a report that is written again
/// takes the place of the former one. For an attempt that is not in a database it is a new folder without a number.
std::filesystem::path attempt_folder(const std::filesystem::path& folder, const Attempt& attempt);

/// Writes the files of an attempt for people and programs to a folder: report.html, score.json, score.csv, and
/// xapi.json if the attempt is in a database. The same attempt always produces the same bytes, at the end of the exam
/// and later from the database, until a comment is added: report.html shows the comments, and score.json lists them.
/// Throws InputError if the score cannot be read or the folder cannot be written.
/// @param home_page  IRL of the organisation that assigns the learners' ids, for xapi.json; if empty, one that
///                   represents the database
ResultFiles write_report_files(const std::filesystem::path& folder, const Attempt& attempt,
                               const std::string& home_page = {});

}  // namespace insonate
