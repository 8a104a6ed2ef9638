#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "sim/core/pose.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"

namespace insonate::bench {

/// The arguments that all measuring commands share.
struct Request {
  std::vector<std::string> subjects;  ///< case folders, CT files, DICOM folders
  bool built_in = false;              ///< also use the built-in abdomen; it is the default if nothing is named
  std::string view;                   ///< name; empty for the first view
  bool structure = false;             ///< of tissues, as the trainer has it
  int frames = 30;                    ///< number measured per setting
  std::vector<int> configurations;    ///< lines, samples, width, height, repeated; if empty, the command's own
};

/// A patient and the pose of the probe.
struct Scene {
  std::string file;  ///< as the user named it, for messages
  std::string name, view;
  AcousticVolume volume;
  TissueTable table;
  Probe probe;
  double depth_mm = 0;
  Pose pose;
};

/// The fan that a 3D probe sweeps over its pivot.
inline constexpr double kSwept_deg = 60, kPivot_mm = 30;

/// Opens the scenes one by one, so that only one is in memory. Throws InputError.
void for_each_scene(const Request& request, const std::function<void(const Scene&)>& measure);

/// Number of lines and samples, and picture size, as in the paper's table.
struct Configuration {
  int lines, samples, width, height;
};

/// Returns the configurations of the request, or else `usual`. Throws InputError if a number is missing or out of
/// range.
std::vector<Configuration> configurations(const Request& request, const std::vector<Configuration>& usual);

/// The five configurations of Kutter, Shams, Navab 2009.
extern const std::vector<Configuration> kPaperConfigurations;

/// Prints the device, and a warning if it is not a graphics card.
void tell_device();

/// Returns the settings of the paper's pipeline with one sample per reflection length, or those of the trainer with all
/// its effects and two samples per length. Throws InputError if the number of samples does not give a valid length.
Settings settings_of(const Scene& scene, const Configuration& configuration, bool trainer);

/// Returns the probe's pose in a frame. It moves around `start` by a few millimetres along and across the face.
Pose wandering(const Pose& start, int frame);

/// Returns poses as registration requests them around a pose, each offset by some millimetres.
std::vector<Pose> poses_around(const Pose& pose, std::size_t images);

/// Runs the methods in alternation, frame by frame, with the same poses. Measures the time from the pose until the
/// device has finished. A few frames before the measured ones warm up.
/// @param first  number of the first frame, for measurements in several rounds
/// @return milliseconds: per method, per frame
std::vector<std::vector<double>> alternating_times(const Pose& start, int frames,
                                                   const std::vector<std::function<void(const Pose&)>>& methods,
                                                   int first = 0);

}  // namespace insonate::bench
