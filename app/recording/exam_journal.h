#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>

#include "app/session/session.h"
#include "scenarios/results/database/sitting.h"

namespace insonate {

/// Stores an exam under strict rules in the results database while it is in progress, once per second. If the program
/// is killed, the stored part remains. Writes on its own thread, so that drawing never waits for a disk.
class ExamJournal {
public:
  /// @param sitting  the exam's sitting, without number, digest and times. It begins with the first sample.
  ExamJournal(std::filesystem::path database, Sitting sitting);
  ExamJournal(const ExamJournal&) = delete;
  ExamJournal& operator=(const ExamJournal&) = delete;

  /// To be called after each Session::advance(). Throws ExamTaken if this program may not, or may no longer, take the
  /// exam. Other errors of the database are thrown once, and the write is retried every second.
  void take(const Session& session);

  /// Waits until all is written. Returns the number of the sitting, or 0 if it was never stored in the database. Throws
  /// ExamTaken as take() does. Ignores other errors: storing the attempt will report the same ones.
  std::int64_t finish(const Session& session);

private:
  bool idle() const;
  void write(const Session& session);
  void settle();

  std::filesystem::path database_;
  Sitting sitting_;              ///< used by the writing thread while writing_ is pending
  std::future<void> writing_;    ///< the latest part
  std::size_t handed_over_ = 0;  ///< samples passed to the thread
  std::size_t kept_ = 0;         ///< samples stored in the database
  double tried_s_ = 0;           ///< on the session's clock
  bool reported_ = false;        ///< whether the current failure has been thrown
};

}  // namespace insonate
