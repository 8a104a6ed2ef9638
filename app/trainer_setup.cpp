// The trainer's trackers and their calibration: what a session opens, and the set-up that makes it.

#include <cstdio>
#include <ctime>
#include <utility>

#include "app/trainer.h"
#include "devices/calibrated_tracker.h"
#include "devices/registry.h"
#include "sim/core/files.h"
#include "sim/core/input_error.h"

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

bool Trainer::uses_calibration(const Request& request) const {
  // What is dropped on the window is no tracker of the command line's.
  return !options_.calibration.empty() && !request.tracker.empty() && request.tracker == options_.tracker;
}

Session::OpenTracker Trainer::opener(const std::string& uri, const Study& study, bool calibrated) {
  calibration_warning_.clear();
  if (!calibrated) return [uri, surroundings = study.surroundings] { return open_tracker(uri, surroundings); };
  const Calibration calibration = read_complete_calibration(options_.calibration);
  calibration_warning_ = joined(calibration_warnings(calibration, tracker_identity(uri),
                                                     std::int64_t(std::time(nullptr)), options_.calibration_days));
  if (!calibration_warning_.empty()) std::fprintf(stderr, "insonate: %s\n", calibration_warning_.c_str());
  return [sensor = sensor_uri(uri, true), calibration, name = options_.calibration.filename().string()] {
    return std::make_unique<CalibratedTracker>(open_tracker(sensor), calibration, name);
  };
}

bool Trainer::needs_setup(const Request& request) const {
  std::error_code error;
  if (options_.headless || setup_left_ || !uses_calibration(request)) return false;
  return !std::filesystem::exists(options_.calibration, error) ||
         !why_incomplete(read_calibration(options_.calibration)).empty();
}

void Trainer::begin_setup() {
  if (setup_ || !study_) return;
  attempt([&] { open_setup(); });
  if (!setup_ && !session_) load({});
}

void Trainer::open_setup() {
  const std::string uri = current_.tracker;
  const bool live = session_ && std::as_const(*session_).source().live();
  if (uri.empty() || (!live && !uses_calibration(current_)))
    throw InputError("set-up", "", "no tracker with a sensor is used",
                     "start the trainer with one, as in 'insonate --tracker hydra:'");
  check_can_be_calibrated(uri);
  const std::filesystem::path file =
      options_.calibration.empty() ? options_.out / "calibration.toml" : options_.calibration;
  Calibration base = calibration_to_go_on(file, tracker_identity(uri));
  SetupGiven given;
  given.landmarks = landmarks_for(study_->subject.name, options_.landmarks);
  if (!options_.drawing.empty()) given.drawing = read_probe_drawing(options_.drawing);
  session_.reset();  // which lets go of the tracker
  calibration_warning_.clear();
  setup_ = std::make_unique<SetupWizard>(open_tracker(sensor_uri(uri, false), study_->surroundings), std::move(base),
                                         std::move(given), file);
}

void Trainer::end_setup() {
  if (!setup_) return;
  const std::string missing = why_incomplete(setup_->calibration());
  options_.tracker = current_.tracker;
  if (missing.empty()) options_.calibration = setup_->file();
  setup_left_ = !missing.empty();
  setup_.reset();
  const Request again = current_;
  attempt([&] { begin(study_, again); });
  if (!session_) return load({});
  if (setup_left_)
    calibration_warning_ = "The set-up is not complete: the step '" + missing +
                           "' is still to be made. The probe is where the tracker's first pose put it.";
}

}  // namespace insonate
