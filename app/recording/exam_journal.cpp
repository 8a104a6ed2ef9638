#include "app/recording/exam_journal.h"

#include <chrono>
#include <utility>

#include "app/recording/results.h"
#include "devices/sequence/sequence.h"
#include "scenarios/results/database/results_database.h"

namespace insonate {
namespace {

constexpr double kPart_s = 1;

/// Returns the samples from index `first` on as a sequence file, with their actions.
std::string log_of(const Session& session, std::size_t first) {
  const std::vector<ProbeSample>& all = session.exam_samples();
  const std::vector<ProbeSample> samples(all.begin() + std::ptrdiff_t(first), all.end());
  return write_sequence(samples, to_texts(session.actions()));
}

}  // namespace

ExamJournal::ExamJournal(std::filesystem::path database, Sitting sitting)
    : database_(std::move(database)), sitting_(std::move(sitting)) {}

bool ExamJournal::idle() const {
  return !writing_.valid() || writing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Throws the error of the latest part, which is not stored then.
void ExamJournal::settle() {
  if (!writing_.valid()) return;
  writing_.get();
  kept_ = handed_over_;
  reported_ = false;
}

void ExamJournal::write(const Session& session) {
  handed_over_ = session.exam_samples().size();
  tried_s_ = session.now_s();
  writing_ = std::async(std::launch::async, [this, log = log_of(session, kept_)] {
    ResultsDatabase database = ResultsDatabase::open(database_);
    sitting_.number > 0 ? database.add_part(sitting_.number, log) : database.begin(sitting_, log);
  });
}

void ExamJournal::take(const Session& session) {
  if (!idle()) return;
  try {
    settle();
  } catch (const ExamTaken&) {
    throw;
  } catch (const InputError&) {
    if (!std::exchange(reported_, true)) throw;
  }
  const bool due = handed_over_ == 0 || session.now_s() - tried_s_ >= kPart_s;
  if (due && session.exam_samples().size() > kept_) write(session);
}

std::int64_t ExamJournal::finish(const Session& session) {
  for (const bool last : {false, true}) {
    try {
      settle();
      if (!last && session.exam_samples().size() > kept_) write(session);
    } catch (const ExamTaken&) {
      throw;
    } catch (const InputError&) {
    }
  }
  return sitting_.number;
}

}  // namespace insonate
