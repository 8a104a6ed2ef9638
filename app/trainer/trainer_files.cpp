// The files that the trainer writes: recordings, pictures, clips, swept volumes, and the results of exams.

#include <exception>
#include <utility>

#include "app/trainer/trainer.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/files/png.h"

namespace insonate {
namespace {

/// Returns the name of a picture, clip or volume that is begun now, without its ending.
std::filesystem::path name_of_saved(const std::filesystem::path& out, const char* folder = "pictures") {
  return out / folder / file_time(now_since_1970_ms());
}

std::string in_folder_of(const std::filesystem::path& file) {
  return " in " + std::filesystem::absolute(file).parent_path().string();
}

}  // namespace

Notice notice_of_saved(const std::filesystem::path& file) {
  return {"Saved " + file.filename().string() + in_folder_of(file), file};
}

void Trainer::toggle_sweep() {
  if (!can_sweep()) return;
  if (sweep_.running()) return sweep_.stop();
  sweep_case_ = loaded_case_;
  sweep_.start();
}

void Trainer::notice_sweep() {
  if (sweep_.running() && !session()) sweep_.stop();
  attempt([&] {
    std::shared_ptr<const SweptVolume> finished = sweep_.take_finished();
    if (!finished || sweep_case_ != loaded_case_) return;
    swept_ = std::move(finished);
    swept_is_saved_ = false;
    notices_.push_back({"The swept volume is made: U shows it", {}});
  });
}

void Trainer::save_swept() {
  if (!swept_) return;
  attempt([&] {
    const std::filesystem::path file = free_path(name_of_saved(options_.out, "volumes"), ".nrrd");
    write_swept(file, *swept_);
    swept_is_saved_ = true;
    notices_.push_back(notice_of_saved(file));
  });
}

void Trainer::start_recording() {
  // What the command line names is taken once; later recordings lie beside it.
  const bool named = !options_.record.empty() && !std::exchange(recorded_, true);
  recorder_.start(options_.record.empty() ? options_.out / "recording.igs.mha" : options_.record, named);
}

void Trainer::finish_recording() {
  recorder_.stop();
  recorder_.wait();
  attempt([&] { recorder_.check(); });
  clip_.stop();
  clip_.wait();
  attempt([&] { clip_.take_finished(); });
}

void Trainer::save_picture(const Image<Rgba8>& picture) {
  attempt([&] {
    const std::filesystem::path file = free_path(name_of_saved(options_.out), ".png");
    write_png(file, picture);
    notices_.push_back(notice_of_saved(file));
  });
}

void Trainer::start_clip() {
  attempt([&] { clip_.start(name_of_saved(options_.out)); });
}

void Trainer::notice_recordings() {
  attempt([&] {
    if (const auto clip = clip_.take_finished()) notices_.push_back(notice_of_saved(*clip));
  });
  const std::vector<std::filesystem::path> files = recorder_.take_finished();
  if (files.empty()) return;
  std::string names = files.front().filename().string();
  if (files.size() > 1) names += " and, from each new start on, " + files.back().filename().string();
  notices_.push_back({"Recorded " + names + in_folder_of(files.front()), files.front()});
}

void Trainer::write_results_if_due() {
  if (!std::exchange(results_due_, false) || !scan()) return;
  scan()->best_frames.forget_older(*session());
  attempt([&] { keep_and_report(); });
}

void Trainer::keep_and_report() {
  const Session& session = *scan()->session;
  Attempt finished = finished_attempt(session, current_.source, options_.learner,
                                      scan()->best_frames.report_pictures(session, pictures_));
  // A log that is only watched, as when the trainer starts, is nobody's attempt.
  const bool replayed = session.source().recording() != nullptr;
  std::exception_ptr not_kept;
  if (results_ && options_.mode != Mode::replay && (!replayed || !options_.results.empty())) {
    try {
      auto* exam = std::get_if<Exam>(&mode_);
      ExamJournal* journal = exam ? exam->journal.get() : nullptr;
      const std::int64_t sitting = journal ? journal->finish(session) : 0;
      if (journal && sitting == 0) results_->check_not_taken(options_.learner, loaded_case_->scenario->digest);
      results_->add(finished, sitting);
    } catch (const InputError&) {
      not_kept = std::current_exception();  // the report is wanted all the more
    }
  }
  result_files_ =
      write_report_files(options_.headless ? options_.out : attempt_folder(options_.out, finished), finished);
  if (not_kept) std::rethrow_exception(not_kept);
}

}  // namespace insonate
