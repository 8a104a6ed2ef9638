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
  arguments.add_option("--seed", options.seed, "Draws the scenario's variant, where it has any");
  arguments.add_flag(
      "--exam", options.exam,
      "An exam that counts: once for a learner, without hints, practice or a second beginning, and what\n"
      "is left unfinished is scored as it is; the variant is drawn unless --seed says which");
  arguments.add_flag("--author", options.author,
                     "Make reference views of the case folder: hold the probe, freeze, name, keep");
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
  arguments
      .add_option("--replay", options.replay.log,
                  "Look at a recorded scan again, at any time of it and at any speed; nothing of it is scored or kept")
      ->type_name("LOG");
  arguments
      .add_option("--replay-attempt", options.replay.attempt, "The same of an attempt in the database of --results")
      ->check(CLI::PositiveNumber)
      ->type_name("NUMBER");
  arguments.add_option("--beside", options.replay.beside_log, "For a replay: an expert's scan, to compare with")
      ->type_name("LOG");
  arguments.add_option("--beside-attempt", options.replay.beside_attempt, "The same of an attempt in that database")
      ->check(CLI::PositiveNumber)
      ->type_name("NUMBER");
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
  arguments
      .add_option("--quality", options.quality,
                  "What the ultrasound may cost: fast, balanced or exact, the first with fewer samples and pixels and\n"
                  "the last with more samples; no score feels it")
      ->check(CLI::IsMember(quality_names()))
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
      "  insonate --author --case patient7 --tracker hydra:    an expert's planes become the case's views\n"
      "  insonate --replay scan.igs.mha --beside expert.igs.mha --scenario exam.toml\n"
      "  insonate --headless --out results                 score the bundled scan without a window\n"
      "\nExit codes: 0 done, 2 input that cannot be used, 3 any other failure.");
}

namespace {

/// Before anything is loaded: a dialog later would leave a run that nobody has recorded.
void check_record_raw(const Options& options) {
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

void refuse(const std::string& option, const std::string& problem, const std::string& remedy) {
  throw InputError("command line", option, problem, remedy);
}

void check_replay(const Options& options) {
  const ReplaySource& replay = options.replay;
  const bool kept = replay.attempt > 0 || replay.beside_attempt > 0;
  if (!replay.log.empty() && replay.attempt > 0)
    refuse("--replay-attempt", "--replay names a run already", "give one of them");
  if (!replay.beside_log.empty() && replay.beside_attempt > 0)
    refuse("--beside-attempt", "--beside names a run already", "give one of them");
  if (!replay.any() && (kept || !replay.beside_log.empty()))
    refuse("--beside", "there is no run to lay it beside", "name one with --replay or --replay-attempt");
  if (!replay.any()) return;
  if (kept && options.results.empty())
    refuse(replay.attempt > 0 ? "--replay-attempt" : "--beside-attempt", "no database of results is named",
           "name the one that the attempt is in: --results");
  if (!kept && !options.results.empty())
    refuse("--results", "nothing of a replay is kept", "leave it out, or name an attempt with --replay-attempt");
  if (!options.tracker.empty()) refuse("--tracker", "a replay has no use for a tracker", "leave it out");
  if (!options.record.empty() || options.record_images)
    refuse("--record", "a replay is not recorded again", "leave it out");
  const bool named = !options.scenario.empty() || !options.case_folder.empty() || !options.ct.empty();
  if (replay.attempt > 0 && named)
    refuse("--replay-attempt", "the attempt brings its scenario and patient along",
           "leave --scenario, --case and --ct out");
}

void check_author(const Options& options) {
  if (!options.author) return;
  if (options.case_folder.empty())
    refuse("--author", "there is no case to make views of", "name its folder with --case");
  if (!options.scenario.empty()) refuse("--author", "views are not made in an exam", "leave --scenario out");
  if (options.exam) refuse("--author", "views are not made in an exam", "leave --exam out");
  if (options.headless) refuse("--author", "it needs a window", "leave --headless out");
  if (options.replay.any()) refuse("--author", "a replay is not scanned in", "name the recorded scan with --tracker");
}

void check_exam(const Options& options) {
  if (!options.exam) return;
  if (options.learner == kNobodyInParticular)
    refuse("--exam", "it does not say who takes it", "name the learner's id with --learner");
  if (options.replay.any()) refuse("--exam", "a replay is no exam", "leave it out");
  if (options.scenario.empty() && !(options.case_folder.empty() && options.ct.empty()))
    refuse("--exam", "there is no scenario to be taken", "name it with --scenario");
  if (options.headless && options.results.empty())
    refuse("--exam", "it is not said where it is kept", "name a database with --results");
  if (options.tracker.empty())
    refuse("--exam", "it does not say what the learner scans with", "name a tracker, as in --tracker mouse:");
  if (!options.igtl_server.empty())
    refuse("--igtl-server", "in an exam that counts nobody else is told where the probe is", "leave it out");
  if (!options.shader_folder.empty())
    refuse("--shader-dir", "an exam that counts is drawn as the program draws it", "leave it out");
}

}  // namespace

void check(const Options& options) {
  check_replay(options);
  check_author(options);
  check_exam(options);
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
