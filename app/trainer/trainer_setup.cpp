// The trainer's trackers and their calibration: what a session opens, and the set-up that makes it.

#include <cstdio>
#include <ctime>
#include <utility>

#include "app/recording/run_files.h"
#include "app/trainer/trainer.h"
#include "devices/calibrated_tracker.h"
#include "devices/registry.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

/// The patient's landmarks. The built-in list is of the built-in patient and of no other.
std::optional<LandmarkList> landmarks_for(const std::string& patient, const std::filesystem::path& file) {
  LandmarkList list = read_landmark_list(file.empty() ? assets_folder() / "calibration" / "abdomen.toml" : file);
  if (file.empty() && list.patient != patient) return std::nullopt;
  return list;
}

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : " ") + sentence;
  return text;
}

}  // namespace

std::filesystem::path Trainer::own_calibration(const std::string& uri) const {
  // A rehearsal leaves the lab's own set-up alone.
  return options_.out / (is_rehearsal(uri) ? "rehearsed_calibration.toml" : "calibration.toml");
}

void Trainer::find_calibration() {
  const std::filesystem::path file = own_calibration(options_.tracker);
  std::error_code error;
  if (!options_.calibration.empty() || options_.tracker.empty() || !can_store_setup(options_.tracker)) return;
  if (!std::filesystem::exists(file, error)) return;
  // Nobody has named the file, so that nothing about it stops a session.
  try {
    const Calibration calibration = read_complete_calibration(file);
    if (calibration.tracker == tracker_identity(options_.tracker)) {
      options_.calibration = file;
      std::fprintf(stderr, "insonate: uses the set-up in %s; --calibration FILE uses another\n", file.c_str());
      return;
    }
    why_not_calibrated_ =
        "The set-up in " + file.string() + " is of another tracker (" + calibration.tracker.words() + ").";
  } catch (const InputError& unusable) {
    why_not_calibrated_ = std::string("The last set-up is not used: ") + unusable.what();
  }
  std::fprintf(stderr, "insonate: %s\n", why_not_calibrated_.c_str());
}

std::string Trainer::next_start() const {
  const std::string& uri = current_.tracker;
  if (is_rehearsal(uri)) return "The made-up hand scans with it in free practice.";
  const bool plain = uri.find_first_of("?&* '\"$;") == std::string::npos;
  const std::string command = "insonate --tracker " + (plain ? uri : "'" + uri + "'");
  const std::filesystem::path file = options_.calibration.empty() ? own_calibration(uri) : options_.calibration;
  if (file == own_calibration(uri) && can_store_setup(uri))
    return "From the next start on it is used by itself, as long as you start in the same folder: " + command +
           (options_.out == Options().out ? "" : " --out " + options_.out.string());
  return "To use it from the next start on: " + command + " --calibration " + file.string();
}

bool Trainer::uses_calibration(const Request& request) const {
  // What is dropped on the window is not the command line's tracker.
  return !options_.calibration.empty() && !request.tracker.empty() && request.tracker == options_.tracker;
}

Session::OpenTracker Trainer::opener(const std::string& uri, const LoadedCase& loaded_case, bool calibrated) {
  calibration_warning_ = !calibrated && uri == options_.tracker ? why_not_calibrated_ : "";
  if (!calibrated) return [uri, surroundings = loaded_case.surroundings] { return open_tracker(uri, surroundings); };
  const Calibration calibration = read_complete_calibration(options_.calibration);
  calibration_warning_ = joined(calibration_warnings(calibration, tracker_identity(uri),
                                                     std::int64_t(std::time(nullptr)), options_.calibration_days));
  const LandmarkList built_in = read_landmark_list(assets_folder() / "calibration" / "abdomen.toml");
  if (calibration.mannequin->value.patient == built_in.patient && loaded_case.subject.name != built_in.patient)
    calibration_warning_ += std::string(calibration_warning_.empty() ? "" : " ") +
                            "The set-up is of the built-in patient: on this one the probe lies elsewhere.";
  if (!calibration_warning_.empty()) std::fprintf(stderr, "insonate: %s\n", calibration_warning_.c_str());
  return [sensor = sensor_uri(uri, true), calibration, name = options_.calibration.filename().string(),
          surroundings = loaded_case.surroundings] {
    return std::make_unique<CalibratedTracker>(SensorTracker(open_tracker(sensor, surroundings)), calibration, name);
  };
}

void Trainer::record_raw(Session& session, const Request& request) {
  // What is dropped on the window is not the command line's tracker.
  if (options_.record_raw.empty() || request.tracker != options_.tracker || !session.tracker()) return;
  const bool calibrated = uses_calibration(request) && !setup_left_;
  const std::string uri = calibrated ? sensor_uri(request.tracker, true) : request.tracker;
  // Each session begins a file of its own, as its recording does.
  std::error_code error;
  int part = 1;
  while (std::filesystem::exists(part_of(options_.record_raw, part), error)) ++part;
  const std::filesystem::path file = part_of(options_.record_raw, part);
  raw_ = insonate::record_raw(*session.tracker(), file, uri, session.loaded_case().surroundings.start);
}

void Trainer::check_raw() {
  if (!raw_ || raw_->problem().empty()) return;
  const std::string problem = raw_->problem();
  raw_.reset();
  throw InputError(problem);
}

bool Trainer::needs_setup(const Request& request) const {
  std::error_code error;
  if (options_.headless || setup_left_) return false;
  if (options_.mode == Mode::setup && request.tracker == options_.tracker) return true;
  if (!uses_calibration(request)) return false;
  return !std::filesystem::exists(options_.calibration, error) ||
         !why_incomplete(read_calibration(options_.calibration)).empty();
}

bool Trainer::setup_leaves() const {
  return session() && !can_be_set_up(current_);
}

void Trainer::begin_setup() {
  if (setup() || replay() || in_exam()) return;
  if (setup_leaves()) show_start_page();
  if (StartPage* page = start_page()) {
    page->task = Task::setup;
    return;
  }
  if (!loaded_case_) return;
  attempt([&] { open_setup(); });
  if (std::holds_alternative<Idle>(mode_)) show_start_page();
}

bool Trainer::can_be_set_up(const Request& request) const {
  const bool live = session() && session()->source().live();
  const bool asked_for = options_.mode == Mode::setup && request.tracker == options_.tracker;
  return !request.tracker.empty() && (live || asked_for || uses_calibration(request));
}

void Trainer::open_setup() {
  const std::string uri = current_.tracker;
  check_can_be_calibrated(uri);
  const std::filesystem::path file = options_.calibration.empty() ? own_calibration(uri) : options_.calibration;
  Calibration base = calibration_to_continue(file, tracker_identity(uri));
  SetupInput given;
  given.landmarks = landmarks_for(loaded_case_->subject.name, options_.landmarks);
  if (!options_.drawing.empty()) given.drawing = read_probe_drawing(options_.drawing);
  mode_ = Idle();  // which lets go of the tracker
  calibration_warning_.clear();
  mode_ = SettingUp{
      std::make_unique<SetupWizard>(SensorTracker(open_tracker(sensor_uri(uri, false), loaded_case_->surroundings)),
                                    std::move(base), std::move(given), file)};
}

void Trainer::end_setup() {
  if (!setup()) return;
  const Calibration& made = setup()->calibration();
  const std::string missing = why_incomplete(made);
  // Who has only looked at a set-up that nobody has begun is not told that it is incomplete.
  const bool is_begun = made.axes || made.tip || made.face || made.mannequin || made.lag || uses_calibration(current_);
  const std::string title = setup()->title_of(missing);
  const bool is_own_mode = options_.mode == Mode::setup, from_start_page = given_.mode != Mode::setup;
  if (missing.empty()) notices_.push_back({"The set-up is complete: scans with this tracker use it", setup()->file()});
  if (is_own_mode && (from_start_page || !missing.empty())) {
    show_start_page();
    start_page()->task = missing.empty() ? Task::practice : Task::setup;
    if (missing.empty() && is_rehearsal(start_page()->tracker())) start_page()->scenario.reset();
    return;
  }
  if (is_own_mode) options_.mode = Mode::practice;
  options_.tracker = current_.tracker;
  if (missing.empty()) options_.calibration = setup()->file();
  why_not_calibrated_.clear();
  setup_left_ = !missing.empty();
  mode_ = Idle();
  Request again = current_;
  again.free_practice = again.free_practice || (is_own_mode && options_.scenario.empty());
  attempt([&] { begin(loaded_case_, again); });
  if (!session() && in_exam()) return;
  if (!session()) return show_start_page();
  if (setup_left_ && is_begun)
    calibration_warning_ = "The step \"" + title +
                           "\" of the set-up is still to be made: the probe is where the tracker's first pose put it.";
}

}  // namespace insonate
