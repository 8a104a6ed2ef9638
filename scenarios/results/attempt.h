#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/report/report.h"
#include "scenarios/results/database/comment.h"
#include "scenarios/runner.h"

namespace insonate {

/// One attempt at an exam, with everything that its score was computed from, so that it can be scored again. Texts stay
/// as they were written: a later version of the program can store and copy texts that it can no longer read.
struct Attempt {
  std::int64_t number = 0;       ///< number in its database, from 1; 0 until it is stored in one
  std::string database;          ///< the database's identity; empty until it is stored in one
  std::string uuid;              ///< RFC 4122, lower case; identifies the attempt everywhere; empty until it is stored
  std::string learner;           ///< an opaque id (learner_id.h)
  std::int64_t finished_ms = 0;  ///< since 1970 UTC, without leap seconds; 0 to the year 9999
  std::string scenario_text;     ///< bytes of the scenario file
  std::string scenario_file;     ///< path of that file: its case folder may be relative to this path
  std::string patient;           ///< case folder or CT that replaced the scenario's case; empty for none
  std::string log;               ///< the scored samples, as a sequence file without pictures
  std::string score_json;        ///< result_json.h
  std::string trace_json;        ///< trace_json.h
  std::vector<ReportPicture> pictures;  ///< at most one of each kind per step
  std::vector<Comment> comments;        ///< in the order in which they were written; empty until it is stored
};

/// Returns an attempt from a runner's scenario and trace, and its result and log. The caller fills in learner, time and
/// patient.
Attempt attempt_of(const Runner& runner, const ExamResult& result, std::string log);

/// Returns the current time, as Attempt::finished_ms.
std::int64_t now_since_1970_ms();

/// Returns Attempt::finished_ms as text, such as "2026-11-21T18:05:09.250Z".
std::string utc_time(std::int64_t since_1970_ms);
/// Returns the time in UTC to the second, in characters that every file system takes: "2026-11-24T21-57-03Z".
std::string file_time(std::int64_t since_1970_ms);

}  // namespace insonate
