#include "app/trainer/options.h"

#include <array>

#include "app/pictures/igtl_feed.h"
#include "devices/calibrated_tracker.h"
#include "devices/record/raw_recorder.h"
#include "devices/record/recording_files.h"
#include "devices/registry.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

CLI::Option* add_case(CLI::App& mode, Options& options) {
  return mode.add_option("--case", options.case_folder, "Take the patient of this case folder")->type_name("FOLDER");
}

/// Returns the two options.
std::array<CLI::Option*, 2> add_patient(CLI::App& mode, Options& options) {
  CLI::Option* const folder = add_case(mode, options)->default_str("the scenario's patient");
  CLI::Option* const ct =
      mode.add_option("--ct", options.ct,
                      "Take this CT as the patient: NIfTI, NRRD, MetaImage, or a folder of DICOM files")
          ->type_name("PATH")
          ->excludes(folder);
  return {folder, ct};
}

CLI::Option* add_scenario(CLI::App& mode, Options& options) {
  CLI::Option* const scenario =
      mode.add_option("--scenario", options.scenario, "Take the steps of this scenario, a TOML file")
          ->type_name("FILE")
          ->default_str("the bundled exam if no patient is named");
  mode.add_option("--seed", options.seed, "Draw the scenario's variant with this seed, if it has variants")
      ->default_str("0");
  return scenario;
}

CLI::Option* add_tracker(CLI::App& mode, Options& options) {
  std::string trackers = "Take the probe's poses from this tracker:";
  for (const TrackerKind& kind : tracker_kinds())
    trackers += "\n  " + std::string(kind.form) + "\n      " + std::string(kind.summary);
  CLI::Option* const tracker = mode.add_option("--tracker", options.tracker, trackers)->type_name("URI");
  mode.add_option("--calibration", options.calibration,
                  "Use this calibration of the tracker, if it reports where its sensor is; `insonate setup` makes one")
      ->type_name("FILE")
      ->needs(tracker);
  mode.add_option("--calibration-days", options.calibration_days, "Warn of a calibration that is older than this, days")
      ->check(CLI::Range(0.0, 3650.0))
      ->capture_default_str();
  mode.add_option(
          "--predict", options.predict_ms,
          "Predict a live tracker's pose at the time of the picture, at most this far ahead, ms; 0 turns it off")
      ->check(CLI::Range(0.0, 1e3 * PoseHistory::kPredict_s))
      ->capture_default_str();
  mode.add_option("--latency", options.latency,
                  "Write a histogram of the time from a live tracker's reports to the picture (CSV)")
      ->type_name("FILE");
  return tracker;
}

/// The files that the set-up uses.
void add_setup_files(CLI::App& mode, Options& options) {
  mode.add_option("--landmarks", options.landmarks, "Use these landmarks of the patient in the set-up")
      ->type_name("FILE")
      ->default_str("those of the built-in patient");
  mode.add_option("--drawing", options.drawing,
                  "Use this drawing of the probe in the set-up, so that its face need not be touched")
      ->type_name("FILE");
}

void add_recording(CLI::App& mode, Options& options) {
  mode.add_option("--record", options.record, "Record every sample of the run as a sequence file (.igs.mha)")
      ->type_name("FILE");
  mode.add_flag("--record-images", options.record_images,
                "Record the ultrasound too, in a second file: sweep-images.igs.mha beside sweep.igs.mha");
  mode.add_option("--record-raw", options.record_raw,
                  "Record what a live tracker's device sends, byte for byte; '--tracker raw:FILE' replays it")
      ->type_name("FILE");
}

CLI::Option* add_results(CLI::App& mode, Options& options, const std::string& help) {
  return mode.add_option("--results", options.results, help)->type_name("FILE");
}

CLI::Option* add_learner(CLI::App& mode, Options& options) {
  return mode.add_option("--learner", options.learner, "Store attempts under this learner's id, which is not a name")
      ->type_name("ID")
      ->capture_default_str();
}

CLI::Option* add_headless(CLI::App& mode, Options& options) {
  return mode.add_flag("--headless", options.headless, "Run without a window, as fast as possible");
}

void add_screen(CLI::App& mode, Options& options) {
  mode.add_option("--seconds", options.seconds, "End the session after this many seconds")
      ->check(CLI::Range(0.0, 86400.0))
      ->default_str("without a window: at the end of the exam, or after 10 if there is none");
  mode.add_option("--out", options.out, "Write the report, the score and the pictures to this folder")
      ->each([&](const std::string&) { options.out_named = true; })
      ->type_name("FOLDER")
      ->capture_default_str();
  mode.add_option("--screenshot", options.screenshot, "Write the whole screen as a PNG when the session ends")
      ->type_name("FILE");
  mode.add_option("--width", options.width, "Set the width of the screen, pixels")
      ->check(CLI::Range(1024, 7680))
      ->capture_default_str();
  mode.add_option("--height", options.height, "Set the height of the screen, pixels")
      ->check(CLI::Range(700, 4320))
      ->capture_default_str();
  mode.add_option(
          "--quality", options.quality,
          "Set the cost of the ultrasound: fast has fewer samples and pixels, exact has more samples; scores do "
          "not depend on it")
      ->check(CLI::IsMember(quality_names()))
      ->each([&](const std::string&) { options.quality_named = true; })
      ->capture_default_str();
  CLI::Option* times = mode.add_option("--frame-times", options.frame_times,
                                       "Write how long each frame of the window takes to this file (CSV)")
                           ->type_name("FILE");
  mode.add_flag("--frame-parts", options.frame_parts,
                "Measure the parts of each frame too, by waiting for the graphics card after each")
      ->needs(times);
  mode.add_option("--state-file", options.state_file,
                  "Write what the trainer is doing to this JSON file, and keep it up to date")
      ->type_name("FILE");
}

/// Options that no exam has, because it is drawn as the program draws it, and nobody else may see the probe's pose.
void add_openings(CLI::App& mode, Options& options) {
  mode.add_option("--shader-dir", options.shader_folder,
                  "Load the shaders from this folder, and reload those that change")
      ->type_name("FOLDER");
  mode.add_option(
          "--igtl-server", options.igtl_server,
          "Send the picture, the pose and events to OpenIGTLink clients such as 3D Slicer; only clients on this "
          "computer can connect unless an address is given, as in 0.0.0.0:18944")
      ->type_name("[ADDRESS:]PORT");
}

void add_practice(CLI::App& mode, Options& options) {
  add_patient(mode, options);
  add_scenario(mode, options);
  add_tracker(mode, options);
  add_setup_files(mode, options);
  add_recording(mode, options);
  add_results(mode, options, "Store attempts in this database, those of replayed logs too")
      ->default_str("in a window ~/.local/share/insonate/results.db, without those of replayed logs");
  add_learner(mode, options);
  add_headless(mode, options);
  add_screen(mode, options);
  add_openings(mode, options);
}

void add_exam(CLI::App& mode, Options& options) {
  CLI::Option* const scenario = add_scenario(mode, options);
  for (CLI::Option* patient : add_patient(mode, options)) patient->needs(scenario);
  add_tracker(mode, options)->required();
  add_setup_files(mode, options);
  add_recording(mode, options);
  CLI::Option* const results = add_results(mode, options, "Store the attempt in this database")
                                   ->default_str("in a window ~/.local/share/insonate/results.db");
  add_learner(mode, options)->required();
  mode.get_option("--seed")->default_str("random");
  add_headless(mode, options)->needs(results);
  add_screen(mode, options);
}

void add_replay(CLI::App& mode, Options& options) {
  CLI::Option* const log = mode.add_option("LOG", options.replay.log, "Replay this recorded scan")->type_name("FILE");
  CLI::Option* const results =
      add_results(mode, options, "Read the attempts of --attempt and --beside-attempt from this database");
  CLI::Option* const attempt =
      mode.add_option("--attempt", options.replay.attempt, "Replay this attempt of the database, instead of a LOG")
          ->check(CLI::PositiveNumber)
          ->type_name("NUMBER")
          ->excludes(log)
          ->needs(results);
  CLI::Option* const beside =
      mode.add_option("--beside", options.replay.beside_log, "Show this expert's scan beside the run")
          ->type_name("FILE");
  mode.add_option("--beside-attempt", options.replay.beside_attempt, "Show this attempt of the database beside the run")
      ->check(CLI::PositiveNumber)
      ->type_name("NUMBER")
      ->excludes(beside)
      ->needs(results);
  // An attempt brings its scenario, variant and patient along.
  add_patient(mode, options);
  add_scenario(mode, options);
  for (const char* brought : {"--case", "--ct", "--scenario", "--seed"}) attempt->excludes(mode.get_option(brought));
  add_headless(mode, options);
  add_screen(mode, options);
  add_openings(mode, options);
}

void add_author(CLI::App& mode, Options& options) {
  add_case(mode, options)->required();
  add_tracker(mode, options);
  add_setup_files(mode, options);
  add_recording(mode, options);
  add_screen(mode, options);
  add_openings(mode, options);
}

void add_setup(CLI::App& mode, Options& options) {
  add_patient(mode, options);
  add_tracker(mode, options)->required();
  add_setup_files(mode, options);
  add_screen(mode, options);
}

void add_check(CLI::App& mode, Options& options) {
  mode.add_option("SCENARIO", options.scenario, "Check this scenario file (TOML)")->type_name("FILE")->required();
  add_case(mode, options)->default_str("the scenario's patient");
  add_screen(mode, options);
}

/// Throws InputError for an option before the mode: it would count as one of practice.
void refuse_options_before(const CLI::App& arguments, const CLI::App& mode) {
  for (const CLI::Option* option : arguments.get_options())
    if (option->count() > 0)
      throw InputError("command line", option->get_name(), "it stands before '" + mode.get_name() + "'",
                       "write the mode first and its options behind it");
}

constexpr const char* kExitCodes = "\nExit codes: 0 done, 2 input that cannot be used, 3 any other failure.";

struct ModeText {
  Mode mode;
  const char* name;
  const char* summary;
  void (*add)(CLI::App&, Options&);
  const char* examples;
};

constexpr ModeText kModes[] = {
    {Mode::practice, "practice", "Scan, with or without a scenario, as often as you like; the mode when none is named",
     add_practice,
     "Examples:\n"
     "  insonate practice --tracker mouse:                the bundled exam, the probe in your hands\n"
     "  insonate practice --ct abdomen.nii.gz             free practice on a CT of your own\n"
     "  insonate practice --scenario exam.toml --tracker replay:scan.igs.mha\n"},
    {Mode::exam, "exam",
     "Take an exam that counts: once per learner and without help. An exam that is left unfinished is scored as it is",
     add_exam,
     "Examples:\n"
     "  insonate exam --learner L-07 --tracker auto:\n"
     "  insonate exam --scenario exam.toml --learner L-07 --tracker hydra: --results lab.db\n"},
    {Mode::replay, "replay",
     "Look at a run again, at any time and any speed, alone or beside an expert's. Nothing is scored or stored",
     add_replay,
     "Examples:\n"
     "  insonate replay scan.igs.mha --beside expert.igs.mha --scenario exam.toml\n"
     "  insonate replay --results lab.db --attempt 12 --beside-attempt 3\n"},
    {Mode::author, "author", "Make reference views of a case: hold the probe, freeze, name and store", add_author,
     "Examples:\n"
     "  insonate author --case patient7 --tracker hydra: --calibration lab.toml\n"},
    {Mode::setup, "setup", "Calibrate a tracker step by step, then practise; key F2 does the same", add_setup,
     "Examples:\n"
     "  insonate setup --tracker hydra: --calibration lab.toml\n"},
    {Mode::check, "check", "Show the text of a scenario and what is wrong with it, again whenever the file changes",
     add_check,
     "Example:\n"
     "  insonate check exam.toml\n"},
};

}  // namespace

void declare(CLI::App& arguments, Options& options) {
  arguments.description(
      "Practise bedside ultrasound: live images from CT, guided and scored.\n"
      "Without arguments, a window begins with a page that shows what there is to do.\n"
      "Without a display, the bundled scan of the built-in patient is replayed and scored.");
  add_practice(arguments, options);
  arguments.footer(std::string("Each mode lists its options: insonate exam --help\n") + kExitCodes);
  for (const ModeText& text : kModes) {
    CLI::App* const mode = arguments.add_subcommand(text.name, text.summary);
    text.add(*mode, options);
    mode->footer(std::string(text.examples) + kExitCodes);
    mode->preparse_callback([&arguments, mode](std::size_t) { refuse_options_before(arguments, *mode); });
    mode->parse_complete_callback([&options, chosen = text.mode] {
      options.mode = chosen;
      options.mode_named = true;
    });
  }
  arguments.require_subcommand(0, 1);
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

void check_replay(const Options& options) {
  const ReplaySource& replay = options.replay;
  if (options.mode != Mode::replay) return;
  if (!replay.any())
    throw InputError("command line", "replay", "no run is named",
                     "name a recorded scan, or an attempt as in --results lab.db --attempt 12");
  if (!options.results.empty() && replay.attempt == 0 && replay.beside_attempt == 0)
    throw InputError("command line", "--results", "a replay stores nothing", "leave it out, or name an --attempt");
}

}  // namespace

bool begins_on_start_page(const Options& options) {
  const bool named = options.mode_named || !options.case_folder.empty() || !options.ct.empty() ||
                     !options.scenario.empty() || !options.tracker.empty();
  return !options.headless && !named && options.seconds == 0 && options.screenshot.empty();
}

void check(const Options& options) {
  check_replay(options);
  if (!options.igtl_server.empty()) parse_server_address(options.igtl_server);
  check_learner_id(options.learner, "command line", "--learner");
  if (options.mode == Mode::exam && options.learner == kNobodyInParticular)
    throw InputError("command line", "--learner", "'" + options.learner + "' can be anybody", "name the learner's id");
  if (!options.calibration.empty() || options.mode == Mode::setup) check_can_be_calibrated(options.tracker);
  if (options.record_images && options.headless && options.record.empty())
    throw InputError("command line", "--record-images", "no file to record to is named", "give --record FILE too");
  if (!options.record.empty()) refuse_existing(options.record);
  check_record_raw(options);
  std::error_code error;
  if (!options.shader_folder.empty() && !std::filesystem::is_directory(options.shader_folder, error))
    throw InputError(options.shader_folder.string(), "--shader-dir", "it is not a folder",
                     "name a folder laid out as sim/shaders");
}

}  // namespace insonate
