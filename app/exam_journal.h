#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>

#include "app/session.h"
#include "scenarios/results/sitting.h"

namespace insonate {

/// Keeps an exam that counts in the database of results while it lasts, a second at a time, so that a program that is
/// killed leaves what there was of it. It writes on a thread of its own: whoever draws never waits for a disk.
class ExamJournal {
public:
  /// @param sitting  whose exam it is; numbers and times are still to be set. The exam begins with its first sample.
  ExamJournal(std::filesystem::path database, Sitting sitting);
  ExamJournal(const ExamJournal&) = delete;
  ExamJournal& operator=(const ExamJournal&) = delete;

  /// To be called after each Session::advance(). Throws, once, what went wrong with the database; nothing is kept from
  /// then on.
  void take(const Session& session);

  /// Waits until what was begun is written. The number of the sitting in the database; 0 when it never came there.
  std::int64_t finish();

private:
  std::filesystem::path database_;
  Sitting sitting_;            ///< the writing thread's, while writing_ is under way
  std::future<void> writing_;  ///< the newest part
  std::size_t kept_ = 0;       ///< samples handed over
  double kept_until_s_ = 0;    ///< on the session's clock
  bool given_up_ = false;
};

}  // namespace insonate
