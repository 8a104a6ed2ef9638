#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/core/pose.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/settings.h"
#include "sim/model/tissue.h"
#include "sim/probe/probe.h"

namespace insonate::bench {

/// What every measuring command is asked.
struct Request {
  std::vector<std::string> subjects;  ///< case folders, CT files, DICOM folders
  bool built_in = false;              ///< the built-in abdomen too; it stands in when nothing is named
  std::string view;                   ///< by name; the first when empty
  int frames = 30;                    ///< measured per setting
  std::vector<int> configurations;    ///< lines, samples, width, height, and again; the command's own when empty
};

/// A patient and where the probe stands on it.
struct Scene {
  std::string file;  ///< as named by the person, for messages
  std::string name, view;
  AcousticVolume volume;
  TissueTable table;
  Probe probe;
  double depth_mm = 0;
  Pose pose;
};

/// Opens the scenes one after the other, so that no two are held in memory. Throws InputError.
void for_each_scene(const Request& request, const std::function<void(const Scene&)>& measure);

/// Lines, samples and picture of the paper's table.
struct Configuration {
  int lines, samples, width, height;
};

/// Those of the request, or `usual`. Throws InputError when a number is missing or outside its range.
std::vector<Configuration> configurations(const Request& request, const std::vector<Configuration>& usual);

/// The five of Kutter, Shams, Navab 2009.
extern const std::vector<Configuration> kPaperConfigurations;

/// Prints what is measured, and that it is no graphics card where that is so.
void tell_device();

/// The paper's pipeline as the paper has it, a sample a reflection length, or the trainer's with all that it adds and
/// two samples a length. Throws InputError where so many samples make no such length.
Settings settings_of(const Scene& scene, const Configuration& configuration, bool trainer);

/// Where the probe stands in a frame: it wanders around `start` by a few millimetres along the face and across it.
Pose wandering(const Pose& start, int frame);

/// Runs the methods in turn, frame by frame, each with the same poses, and tells each one's times from the pose to the
/// end of the device's work. A few frames before those that count warm up.
/// @param first  of the frames, for those who measure some of them now and some later
/// @return milliseconds: per method, per frame
std::vector<std::vector<double>> alternating_times(const Pose& start, int frames,
                                                   const std::vector<std::function<void(const Pose&)>>& methods,
                                                   int first = 0);

}  // namespace insonate::bench
