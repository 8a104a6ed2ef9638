#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/replay_source.h"
#include "devices/calibration/calibration.h"
#include "devices/pose_history.h"
#include "scenarios/results/learner_id.h"
#include "sim/model/quality.h"

namespace insonate {

/// What the command line asks of the trainer. Empty paths mean: what is built in.
struct Options {
  std::filesystem::path case_folder;
  std::filesystem::path ct;  ///< a file or a DICOM folder
  std::filesystem::path scenario;
  std::optional<std::uint32_t> seed;  ///< draws the scenario's variant; empty: 0, and of an exam that counts any
  bool exam = false;                  ///< an exam that counts: taken once, under strict rules
  bool author = false;                ///< views of the case folder are made
  std::string tracker;                ///< a tracker's URI
  std::filesystem::path calibration;  ///< of that tracker, whose samples are its sensor's; empty: they are the probe's
  std::filesystem::path landmarks;    ///< of the patient, for the set-up; empty: the built-in patient's
  std::filesystem::path drawing;      ///< of the probe, for the set-up; empty: its face is touched
  double calibration_days = kCalibrationDays;  ///< older ones bring a warning
  ReplaySource replay;                         ///< what is looked at again, in place of a session
  std::filesystem::path record;                ///< where the run is recorded; empty: it is not
  bool record_images = false;                  ///< what is recorded is so with the ultrasound, in a second file
  std::filesystem::path record_raw;            ///< where the live tracker's bytes are recorded; empty: they are not
  double predict_ms = 1e3 * PoseHistory::kPredictS;  ///< how far a live tracker's pose is carried on, at most
  std::filesystem::path latency;  ///< where it is told how long a live tracker's reports take to the picture
  bool headless = false;
  std::filesystem::path screenshot;  ///< a PNG of the whole screen, taken at the end
  double seconds = 0;                ///< end after so long; 0: at the exam's end (headless), never (window)
  std::filesystem::path out = "out";
  std::string quality = name_of(Quality::balanced);  ///< of the ultrasound: one of quality_names()
  std::filesystem::path shader_folder;
  int width = 1280;
  int height = 800;
  std::filesystem::path results;  ///< database of results; empty: the user's own in a window, none without
  std::string learner = kNobodyInParticular;
  std::string igtl_server;           ///< "[ADDRESS:]PORT" to tell OpenIGTLink clients at; empty: nobody is told
  std::filesystem::path state_file;  ///< what the trainer is doing, for programs that drive it
};

/// Declares the options on `arguments`, to be filled into `options` when they are parsed.
void declare(CLI::App& arguments, Options& options);

/// Refuses combinations that contradict each other. Throws InputError.
void check(const Options& options);

}  // namespace insonate
