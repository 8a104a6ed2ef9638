#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/recording.h"
#include "devices/sequence/recorded_images.h"
#include "devices/sequence/sequence.h"
#include "sim/core/probe_sample.h"

namespace insonate {

/// Options for reading a recording.
struct RecordingOptions {
  /// Name of the probe's transform, with or without "Transform" at its end, as in "SensorToTracker". Empty: see
  /// probe_track().
  std::string transform{};
  /// Frame rate in Hz, above 0, for a recording whose frames have no times. 0: such a recording is refused.
  double rate_hz = 0;
  /// Uses 1 Hz for such a recording instead, for callers that do not use its times.
  bool without_times = false;
};

/// The probe's poses from the transforms of a sequence.
struct ProbeTrack {
  std::string transform;             ///< for users: "ProbeToPatient", or "ProbeToTracker, TrackerToReference"
  std::string probe;                 ///< the coordinate frame that is taken for the probe's: "Probe"
  std::vector<ProbeSample> samples;  ///< one per frame
  RecordingRepairs repairs;
  std::optional<double> assumed_rate_hz;  ///< see Recording::assumed_rate_hz
};

/// Largest orthonormal_error() of a recorded pose that is replaced by the nearest rotation. Matrices with 6 significant
/// digits that a tracker chained in single precision have errors up to 4.3e-4 (a recording from PLUS's test data). An
/// axis that is stretched or tilted by 0.001 moves the far end of a 200 mm image by 0.2 mm.
inline constexpr double kRecordedRotationError = 2e-3;

/// Finds the probe's pose in each frame of a sequence, with the frame's own time.
///
/// Without `options.transform` it follows the coordinate frame Probe to Patient, else to Reference, else to Tracker. It
/// uses all transforms of frames and header, in both directions (find_path()). If it reaches none and exactly one
/// transform begins with "Probe", it takes that one. With `options.transform` it takes that transform or path, and
/// continues to Patient if the sequence has such a path. The frame at the end of the path is taken for the patient's,
/// in LPS. 3D Slicer shows RAS on the screen, but in a sequence it saves the transforms as it received them.
///
/// A sample is ok if every link of its path is ok. Otherwise it has the status of the first link that is not, and
/// Pose{}. Frames without the transform are missing. A rotation that is orthonormal up to rounding error is kept bit
/// for bit. A larger error up to kRecordedRotationError is repaired with the nearest rotation and counted.
///
/// Throws InputError if no transform fits or a pose that is ok is not rigid. Also throws it if the frames have no times
/// and the options give no rate, or if they have times and a rate is given.
ProbeTrack probe_track(const Sequence& sequence, const RecordingOptions& options = {});

/// Returns the samples of probe_track() alone.
std::vector<ProbeSample> probe_samples(const Sequence& sequence, std::string_view transform = {});

/// Returns what was done besides moving, by the times of the frames that report them.
std::map<double, std::string> recorded_actions(const Sequence& sequence);

/// A recorded scan: its provenance, samples and images.
struct RecordedScan {
  Recording recording;
  std::vector<ProbeSample> samples;
  std::optional<RecordedImages> images;  ///< empty without images, or if their form is not supported
};

/// Reads a file once and returns its probe_track(). Stores its header and samples. Its images may have any size and
/// stay in the file. Throws InputError.
RecordedScan read_recorded_scan(const std::filesystem::path& file, const RecordingOptions& options = {});

/// Does the same with a parsed sequence. The recording has no digest and no images.
RecordedScan recorded_scan(const Sequence& sequence, const RecordingOptions& options = {});

}  // namespace insonate
