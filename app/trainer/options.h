#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/replay/replay_source.h"
#include "devices/calibration/calibration.h"
#include "devices/pose_history.h"
#include "scenarios/results/learner_id.h"
#include "sim/model/quality.h"

namespace insonate {

/// What the trainer is started for.
enum class Mode {
  practice,  ///< scan, with or without a scenario, as often as one likes; a recorded scan is watched the same way
  exam,      ///< one attempt that counts, under strict rules
  replay,    ///< look at a run again; nothing is scored or stored
  author,    ///< make reference views of a case
  setup,     ///< calibrate the tracker, then practise
  check,     ///< show an author what is wrong with a scenario file, again whenever it changes
};

/// The command line. An empty path or text means what is built in, unless its comment says otherwise.
struct Options {
  Mode mode = Mode::practice;
  bool mode_named = false;  ///< by the person, rather than left to the default

  // The patient and the scenario
  std::filesystem::path case_folder;
  std::filesystem::path ct;  ///< a file or a DICOM folder
  std::filesystem::path scenario;
  std::optional<std::uint32_t> seed;  ///< draws the scenario's variant; empty: 0, in an exam a random one

  // The tracker
  std::string tracker;                                ///< a tracker's URI
  std::filesystem::path calibration;                  ///< of that tracker; empty: its samples are the probe's poses
  double calibration_days = kCalibrationDays;         ///< an older calibration brings a warning, days
  std::filesystem::path landmarks;                    ///< of the patient, for the set-up
  std::filesystem::path drawing;                      ///< of the probe, for the set-up; empty: its face is touched
  double predict_ms = 1e3 * PoseHistory::kPredict_s;  ///< how far ahead a live tracker's pose is predicted, at most

  // What is written
  std::filesystem::path record;      ///< a sequence file of the run; empty: none
  bool record_images = false;        ///< the recording has the ultrasound too, in a second file
  std::filesystem::path record_raw;  ///< the live tracker's bytes; empty: not recorded
  std::filesystem::path latency;     ///< a histogram of the live tracker's latency; empty: none
  std::filesystem::path out = "out";
  bool out_named = false;         ///< by the person, rather than left to the default
  std::filesystem::path results;  ///< database of results; empty: the user's own in a window, none without
  std::string learner = kNobodyInParticular;

  ReplaySource replay;  ///< of Mode::replay

  // The screen
  bool headless = false;
  std::filesystem::path screenshot;  ///< a PNG of the whole screen, written at the end; empty: none
  double seconds = 0;  ///< end after so many seconds; 0: at the exam's end, or after 10 (headless); never (window)
  std::string quality = name_of(Quality::balanced);  ///< of the ultrasound: one of quality_names()
  bool quality_named = false;                        ///< as out_named
  std::filesystem::path shader_folder;
  int width = 1280;
  int height = 800;
  std::string igtl_server;            ///< "[ADDRESS:]PORT" where OpenIGTLink clients connect; empty: no server
  std::filesystem::path frame_times;  ///< a table of the window's frames, written at the end; empty: none
  bool frame_parts = false;           ///< the table has the times of each frame's parts
  std::filesystem::path state_file;   ///< what the trainer is doing, for programs that drive it; empty: none
};

/// Returns whether the trainer begins with its start page: in a window, if nothing says what to do there. A run that
/// ends by itself or leaves a screenshot has nobody to choose.
bool begins_on_start_page(const Options& options);

/// Declares the modes and their options on `arguments`. Parsing fills in `options`. Each mode takes only the options
/// that mean something in it.
void declare(CLI::App& arguments, Options& options);

/// Checks what CLI11 cannot: files, URIs, and options that mean something only without a window. Throws InputError.
void check(const Options& options);

}  // namespace insonate
