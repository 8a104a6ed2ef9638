#include "app/exam_journal.h"

#include <chrono>
#include <exception>
#include <utility>

#include "app/results.h"
#include "devices/sequence/sequence.h"
#include "scenarios/results/results_database.h"

namespace insonate {
namespace {

constexpr double kPart_s = 1;

/// The samples from the `first` one on, with the actions that go with them.
std::string log_of(const Session& session, std::size_t first) {
  const std::vector<PoseSample>& all = session.exam_samples();
  const std::vector<PoseSample> samples(all.begin() + std::ptrdiff_t(first), all.end());
  return write_sequence(samples, to_texts(session.actions()));
}

}  // namespace

ExamJournal::ExamJournal(std::filesystem::path database, Sitting sitting)
    : database_(std::move(database)), sitting_(std::move(sitting)) {}

void ExamJournal::take(const Session& session) {
  const std::size_t samples = session.exam_samples().size();
  const bool due = kept_ == 0 || session.now_s() - kept_until_s_ >= kPart_s;
  if (given_up_ || samples == kept_ || !due) return;
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    given_up_ = true;  // unless it went well
    writing_.get();
    given_up_ = false;
  }
  writing_ = std::async(std::launch::async, [this, log = log_of(session, kept_)] {
    ResultsDatabase database = ResultsDatabase::open_or_make(database_);
    if (sitting_.number > 0) return database.add_part(sitting_.number, log, now_since_1970_ms());
    sitting_.began_ms = now_since_1970_ms();
    database.begin(sitting_, log);
  });
  kept_ = samples;
  kept_until_s_ = session.now_s();
}

std::int64_t ExamJournal::finish() {
  if (writing_.valid()) writing_.wait();
  return sitting_.number;
}

}  // namespace insonate
