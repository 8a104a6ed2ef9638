#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>

#include "app/session/session.h"
#include "scenarios/results/sitting.h"

namespace insonate {

/// Keeps an exam that counts in the database of results while it lasts, a second at a time, so that a program that is
/// killed leaves what there was of it. It writes on a thread of its own: whoever draws never waits for a disk.
class ExamJournal {
public:
  /// @param sitting  whose exam it is; number, digest and times are still to be set. It begins with the first sample.
  ExamJournal(std::filesystem::path database, Sitting sitting);
  ExamJournal(const ExamJournal&) = delete;
  ExamJournal& operator=(const ExamJournal&) = delete;

  /// To be called after each Session::advance(). Throws ExamTaken when the exam is not this program's to take, or not
  /// any more. What else goes wrong with the database is thrown once, and tried again every second.
  void take(const Session& session);

  /// Waits until all is written, and returns the number of the sitting; 0 when it never came to the database. Throws
  /// ExamTaken as take() does; what else goes wrong will go wrong for the attempt too, and is left to it.
  std::int64_t finish(const Session& session);

private:
  bool idle() const;
  void write(const Session& session);
  void settle();

  std::filesystem::path database_;
  Sitting sitting_;              ///< the writing thread's, while writing_ is under way
  std::future<void> writing_;    ///< the newest part
  std::size_t handed_over_ = 0;  ///< samples, to the thread
  std::size_t kept_ = 0;         ///< samples that are in the database
  double tried_s_ = 0;           ///< on the session's clock
  bool told_ = false;            ///< that it goes wrong
};

}  // namespace insonate
