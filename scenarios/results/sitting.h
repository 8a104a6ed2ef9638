#pragma once

#include <cstdint>
#include <string>

#include "sim/core/input_error.h"

namespace insonate {

/// A learner has taken an exam already, is taking it elsewhere, or what there was of it has been handed in.
class ExamTaken : public InputError {
public:
  using InputError::InputError;
};

/// An exam that counts and is not handed in yet. It is kept from its first sample on, so that a program that is killed
/// leaves what there was of it; handed in, it becomes an attempt (attempt.h, which explains the fields of these names).
struct Sitting {
  std::int64_t number = 0;  ///< in its database, from 1; 0 until it is in one
  std::string learner;
  std::int64_t began_ms = 0;  ///< since 1970 UTC
  std::int64_t kept_ms = 0;   ///< since 1970 UTC: when the newest part of its log was kept
  std::string title;          ///< of the scenario
  std::string scenario_text;
  std::string scenario_digest;  ///< as it was kept
  std::string scenario_file;
  std::string patient;
  std::uint32_t seed = 0;  ///< which drew the scenario's variant

  /// Parts are kept every second; after so long without one the program that took the exam counts as gone. It may be
  /// wrong: then its exam is over, as nobody hands one in twice (ExamTaken).
  static constexpr std::int64_t kGivenUpAfter_ms = 15'000;
};

}  // namespace insonate
