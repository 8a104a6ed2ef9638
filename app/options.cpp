#include "app/options.h"

#include "app/igtl_feed.h"
#include "devices/calibrated_tracker.h"
#include "devices/record/raw_recorder.h"
#include "devices/record/recording_files.h"
#include "devices/registry.h"
#include "sim/core/input_error.h"

namespace insonate {

void declare(CLI::App& arguments, Options& options) {
  arguments.description(
      "A bedside ultrasound trainer: live ultrasound from CT, guided and scored.\n"
      "With no arguments it replays the bundled scan of the built-in patient and scores it.");
  arguments.add_option("--case", options.case_folder, "The patient: a case folder")->type_name("FOLDER");
  arguments.add_option("--ct", options.ct, "The patient: a CT (NIfTI, NRRD, MetaImage, or a folder of DICOM files)")
      ->type_name("PATH");
  arguments.add_option("--scenario", options.scenario, "The exam: a scenario file (TOML)")->type_name("FILE");
  std::string trackers = "Where the probe's poses come from:";
  for (const TrackerKind& kind : tracker_kinds())
    trackers += "\n  " + std::string(kind.form) + "\n      " + std::string(kind.summary);
  arguments.add_option("--tracker", options.tracker, trackers)->type_name("URI");
  arguments
      .add_option(
          "--calibration", options.calibration,
          "The tracker's calibration: it tells where its sensor is, not the probe. Key F2 makes it, step by step;\n"
          "that begins by itself while there is none")
      ->type_name("FILE");
  arguments
      .add_option("--landmarks", options.landmarks,
                  "For the set-up: the patient's landmarks, if not the built-in one's")
      ->type_name("FILE");
  arguments
      .add_option("--drawing", options.drawing, "For the set-up: the probe's drawing; its face need not be touched")
      ->type_name("FILE");
  arguments.add_option("--calibration-days", options.calibration_days, "Warn of a calibration that is older")
      ->check(CLI::Range(0.0, 3650.0))
      ->capture_default_str();
  arguments.add_option("--record", options.record, "Record every sample of the run as a sequence file (.igs.mha)")
      ->type_name("FILE");
  arguments.add_flag("--record-images", options.record_images,
                     "Record the ultrasound too, to a second file: FILE-images.igs.mha");
  arguments
      .add_option("--record-raw", options.record_raw,
                  "Record what a live tracker's device sends, byte for byte; '--tracker raw:FILE' replays it")
      ->type_name("FILE");
  arguments
      .add_option(
          "--predict", options.predict_ms,
          "Carry a live tracker's pose on to the time of the picture, for so long at most; 0: show it as it came")
      ->check(CLI::Range(0.0, 1e3 * PoseHistory::kPredictS))
      ->type_name("MS")
      ->capture_default_str();
  arguments
      .add_option("--latency", options.latency,
                  "Write a histogram of how long a live tracker's reports take to the picture (CSV)")
      ->type_name("FILE");
  arguments.add_flag("--headless", options.headless, "Run without a window, as fast as it goes, and write the results");
  arguments.add_option("--seconds", options.seconds, "End after so many seconds of the session")
      ->check(CLI::Range(0.0, 86400.0));
  arguments.add_option("--out", options.out, "Folder for report, score and pictures")
      ->type_name("FOLDER")
      ->capture_default_str();
  arguments
      .add_option("--results", options.results,
                  "Keep the attempts at exams in this database, replayed logs too; without it a window keeps those\n"
                  "that are no replays in ~/.local/share/insonate/results.db")
      ->type_name("FILE");
  arguments.add_option("--learner", options.learner, "Whose attempts they are: an opaque id, no name")
      ->type_name("ID")
      ->capture_default_str();
  arguments.add_option("--screenshot", options.screenshot, "Write the whole screen as a PNG when the session ends")
      ->type_name("FILE");
  arguments.add_option("--width", options.width, "Of the screen, pixels")
      ->check(CLI::Range(1024, 7680))
      ->capture_default_str();
  arguments.add_option("--height", options.height, "Of the screen, pixels")
      ->check(CLI::Range(700, 4320))
      ->capture_default_str();
  arguments.add_option("--shader-dir", options.shader_folder, "Take shaders from this folder and reload what changes")
      ->type_name("FOLDER");
  arguments
      .add_option("--igtl-server", options.igtl_server,
                  "Send picture, pose and events to OpenIGTLink clients such as 3D Slicer;\n"
                  "only to this computer's own unless an address is given, as in 0.0.0.0:18944")
      ->type_name("[ADDRESS:]PORT");
  arguments.add_option("--state-file", options.state_file, "Keep a JSON file that says what the trainer is doing")
      ->type_name("FILE");
  arguments.footer(
      "Examples:\n"
      "  insonate                                          the bundled exam, replayed\n"
      "  insonate --tracker mouse:                         the same exam, the probe in your hands\n"
      "  insonate --ct abdomen.nii.gz                      free practice on a CT of your own\n"
      "  insonate --scenario exam.toml --tracker replay:scan.igs.mha\n"
      "  insonate --headless --out results                 score the bundled scan without a window\n"
      "\nExit codes: 0 done, 2 input that cannot be used, 3 any other failure.");
}

/// Before anything is loaded: a dialog later would leave a run that nobody has recorded.
static void check_record_raw(const Options& options) {
  if (options.record_raw.empty()) return;
  if (options.tracker.empty())
    throw InputError("command line", "--record-raw", "no tracker is named",
                     "name the one whose bytes are to be recorded: --tracker");
  check_sends_bytes(*open_tracker(options.tracker), options.tracker);
  std::error_code error;
  if (std::filesystem::exists(options.record_raw, error))
    throw InputError(options.record_raw.string(), "--record-raw", "there is such a file already",
                     "name another, or remove it");
}

void check(const Options& options) {
  if (!options.igtl_server.empty()) parse_server_address(options.igtl_server);
  if (!options.case_folder.empty() && !options.ct.empty())
    throw InputError("command line", "--ct", "--case and --ct both name a patient", "give one of them");
  check_learner_id(options.learner, "command line", "--learner");
  if (!options.calibration.empty()) {
    if (options.tracker.empty())
      throw InputError("command line", "--calibration", "no tracker is named",
                       "name the one it was made with: --tracker");
    check_can_be_calibrated(options.tracker);
  }
  if (options.record_images && options.headless && options.record.empty())
    throw InputError("command line", "--record-images", "it says that pictures are recorded, but not where",
                     "give --record FILE too");
  if (!options.record.empty()) refuse_existing(options.record);
  check_record_raw(options);
  std::error_code error;
  if (!options.shader_folder.empty() && !std::filesystem::is_directory(options.shader_folder, error))
    throw InputError(options.shader_folder.string(), "--shader-dir", "it is not a folder",
                     "name a folder laid out as sim/shaders");
}

}  // namespace insonate
