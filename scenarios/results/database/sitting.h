#pragma once

#include <cstdint>
#include <string>

#include "sim/core/input_error.h"

namespace insonate {

/// Reports that a learner has already taken an exam or is taking it elsewhere, or that its stored part was handed in.
class ExamTaken : public InputError {
public:
  using InputError::InputError;
};

/// A graded exam that is not handed in yet. It is stored from its first sample on, so that its data survive if the
/// program is killed. When handed in, it becomes an attempt (attempt.h, which explains the fields of the same names).
struct Sitting {
  std::int64_t number = 0;  ///< number in its database, from 1; 0 until it is stored in one
  std::string learner;
  std::int64_t began_ms = 0;  ///< since 1970 UTC
  std::int64_t kept_ms = 0;   ///< since 1970 UTC: when the newest part of its log was stored
  std::string title;          ///< of the scenario
  std::string scenario_text;
  std::string scenario_digest;  ///< digest at the time of storing
  std::string scenario_file;
  std::string patient;
  std::uint32_t seed = 0;  ///< selected the scenario's variant

  /// Parts are stored every second. After this time without a new part, the program that ran the exam counts as gone.
  /// If it still runs, its exam is over: nobody can hand in an exam twice (ExamTaken).
  static constexpr std::int64_t kGivenUpAfter_ms = 15'000;
};

}  // namespace insonate
