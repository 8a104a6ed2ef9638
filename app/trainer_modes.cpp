// What the trainer does besides practice: an exam that counts, a run that is looked at again, and views being made.

#include <random>
#include <utility>

#include "app/trainer.h"
#include "sim/core/input_error.h"

namespace insonate {

/// Of an exam that counts nobody knows the variant beforehand; the result keeps what was drawn.
std::uint32_t Trainer::seed() const {
  if (options_.seed || !options_.exam) return options_.seed.value_or(0);
  return std::random_device()();
}

void Trainer::refuse_second_exam(const Study& study) {
  if (!results_)
    throw InputError("command line", "--exam", "there is no database to keep the attempt in",
                     "name one with --results");
  const std::string learner = "learner '" + options_.learner + "'";
  for (const AttemptSummary& taken : results_->attempts())
    if (taken.learner == options_.learner && taken.scenario_digest == study.scenario->digest)
      throw InputError(learner, "", "the exam has been taken already, as attempt " + std::to_string(taken.number),
                       "start another exam, or practise without --exam");
  for (const Sitting& begun : results_->sittings())
    if (begun.learner == options_.learner && begun.scenario_text == study.scenario->text)
      throw InputError(
          learner, "", "the exam was begun at " + utc_time(begun.began_ms) + " and is not handed in",
          "end it where it is being taken, or have what there is of it scored with 'insonate-score hand-in " +
              results_->file().string() + "'");
}

void Trainer::keep_sitting() {
  if (!options_.exam || !results_ || !session_->runner() || session_->result()) return;
  if (!journal_) journal_.emplace(results_->file(), sitting_of(*session_, current_.source, options_.learner));
  journal_->take(*session_);
}

void Trainer::hand_in_exam() {
  if (!options_.exam || !session_ || session_->result()) return;
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

void Trainer::begin_replay(std::shared_ptr<const Study> study, const Request& request) {
  recorder_.stop();
  show(std::move(study), request);
  setup_.reset();
  session_.reset();
  result_files_.reset();
  results_due_ = false;
  replay_ = std::move(*std::exchange(loaded_replay_, nullptr));
}

}  // namespace insonate
