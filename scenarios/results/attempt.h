#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/report/report.h"
#include "scenarios/runner.h"

namespace insonate {

/// One exam that somebody took, with all that its score was made from, so that it can be scored again. Texts stay as
/// they were written: a later version of the program can keep and hand on what it no longer reads.
struct Attempt {
  std::int64_t number = 0;       ///< in its database, from 1; 0 until it is in one
  std::string database;          ///< the database's identity; empty until it is in one
  std::string uuid;              ///< RFC 4122, lower case; names the attempt wherever it goes; empty until it is in one
  std::string learner;           ///< an opaque id (learner_id.h)
  std::int64_t finished_ms = 0;  ///< since 1970 UTC, leap seconds left out; 0 to the year 9999
  std::string scenario_text;     ///< of the scenario file, as it was
  std::string scenario_file;     ///< where it was read from: the case folder it names may be relative to that
  std::string patient;           ///< case folder or CT that took the place of the scenario's own; empty for none
  std::string log;               ///< the samples that were scored, as a sequence file without pictures
  std::string score_json;        ///< result_json.h
  std::string trace_json;        ///< trace_json.h
  std::vector<ReportPicture> pictures;  ///< at most one of a kind for each step
};

/// What a runner's scenario, trace and result tell of an attempt; learner, time and patient are left to whoever knows.
Attempt attempt_of(const Runner& runner, const ExamResult& result, std::string log);

/// The time now, as Attempt::finished_ms.
std::int64_t now_since_1970_ms();

/// "2026-11-21T18:05:09.250Z", of Attempt::finished_ms.
std::string utc_time(std::int64_t since_1970_ms);

}  // namespace insonate
