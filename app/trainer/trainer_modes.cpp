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

void Trainer::keep_sitting() {
  if (!in_exam() || !results_ || !session_->runner() || session_->result()) return;
  if (!journal_) journal_.emplace(results_->file(), sitting_of(*session_, current_.source, options_.learner));
  try {
    journal_->take(*session_);
  } catch (const ExamTaken&) {
    recorder_.stop();
    session_.reset();  // nobody takes an exam twice
    throw;
  } catch (const InputError& error) {
    const std::string told = std::string("The exam goes on, but is not kept while it lasts: ") + error.what();
    std::fprintf(stderr, "insonate: %s\n", told.c_str());
    if (!options_.headless) problems_.push_back(told);
  }
}

void Trainer::hand_in_exam() {
  if (!in_exam() || !session_ || session_->result()) return;
  session_->hand_in();
  results_due_ = results_due_ || session_->result().has_value();
  write_results_if_due();
}

void Trainer::keep_view() {
  if (!author_ || !session_) return;
  attempt([&] {
    if (const std::optional<ReferenceView> made = author_->keep(*session_)) guide_.add(*made);
  });
}

void Trainer::begin_replay(std::shared_ptr<const LoadedCase> loaded_case, const Request& request) {
  recorder_.stop();
  show(std::move(loaded_case), request);
  setup_.reset();
  session_.reset();
  result_files_.reset();
  results_due_ = false;
  replay_ = std::move(*std::exchange(loaded_replay_, nullptr));
}

}  // namespace insonate
