// What the trainer does besides practice: an exam that counts, a run that is looked at again, and views being made.

#include <cstdio>
#include <random>
#include <utility>

#include "app/trainer/trainer.h"
#include "sim/core/input_error.h"

namespace insonate {

/// Of an exam that counts nobody knows the variant beforehand; the result keeps what was drawn.
std::uint32_t Trainer::seed() const {
  if (options_.seed || !in_exam()) return options_.seed.value_or(0);
  return std::random_device()();
}

void Trainer::refuse_second_exam(const Scenario& exam) {
  if (!results_)
    throw InputError("command line", "exam", "there is no database to keep the attempt in", "name one with --results");
  results_->check_not_taken(options_.learner, exam.digest);
}

void Trainer::keep_sitting(Exam& exam) {
  const Session& session = *exam.session;
  if (!results_ || !session.runner() || session.result()) return;
  if (!exam.journal)
    exam.journal =
        std::make_unique<ExamJournal>(results_->file(), sitting_of(session, current_.source, options_.learner));
  try {
    exam.journal->take(session);
  } catch (const ExamTaken&) {
    recorder_.stop();
    mode_ = Idle();  // nobody takes an exam twice
    if (given_.mode != Mode::exam) show_start_page();
    throw;
  } catch (const InputError& error) {
    const std::string message = std::string("The exam goes on, but is not kept while it lasts: ") + error.what();
    std::fprintf(stderr, "insonate: %s\n", message.c_str());
    if (!options_.headless) problems_.push_back(message);
  }
}

void Trainer::hand_in_exam() {
  if (!in_exam() || !session() || session()->result()) return;
  session()->hand_in();
  results_due_ = results_due_ || session()->result().has_value();
  write_results_if_due();
}

void Trainer::keep_view() {
  if (!author()) return;
  attempt([&] {
    if (const std::optional<ReferenceView> made = author()->keep(*session())) guide_.add(*made);
  });
}

void Trainer::begin_replay(std::shared_ptr<const LoadedCase> loaded_case, const Request& request) {
  recorder_.stop();
  show(std::move(loaded_case), request);
  result_files_.reset();
  results_due_ = false;
  mode_ = Playback{std::move(*std::exchange(loaded_replay_, nullptr))};
}

}  // namespace insonate
