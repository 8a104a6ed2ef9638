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
#include "sim/core/pose_sample.h"

namespace insonate {

/// How a recording is to be read.
struct RecordingOptions {
  /// The probe's transform, with or without "Transform" at its end, as in "SensorToTracker"; empty: see probe_track().
  std::string transform{};
  /// Frames a second of a recording whose frames have no times, Hz, above 0; 0: such a recording is refused.
  double rate_hz = 0;
  /// Takes 1 Hz for such a recording instead, for callers that do not use its times.
  bool without_times = false;
};

/// The probe's poses among the transforms of a sequence.
struct ProbeTrack {
  std::string transform;            ///< for a person: "ProbeToPatient", or "ProbeToTracker, TrackerToReference"
  std::string probe;                ///< the coordinate frame that counts as the probe's: "Probe"
  std::vector<PoseSample> samples;  ///< one per frame
  RecordingRepairs repairs;
  std::optional<double> assumed_rate_hz;  ///< Recording::assumed_rate_hz
};

/// Largest orthonormal_error() of a recorded pose that is replaced by the nearest rotation. Matrices with 6 significant
/// digits that a tracker chained in single precision reach 4.3e-4 (a recording of PLUS's test data); an axis that is
/// stretched or tilted by a thousandth moves the far end of a 200 mm image by 0.2 mm.
inline constexpr double kRecordedRotationError = 2e-3;

/// Finds the probe's pose in each frame of a sequence, with the frame's own time.
///
/// Without `options.transform` the coordinate frame Probe is followed to Patient, else to Reference, else to Tracker,
/// through all transforms of frames and header and in both directions (find_path()). If none can be reached and exactly
/// one transform begins with "Probe", that one is taken. With it, that transform or path is taken, and followed on to
/// Patient where the sequence knows a way. The frame at the end counts as the patient's, in LPS. 3D Slicer shows RAS on
/// the screen, but what it saves in a sequence are the transforms as they came.
///
/// A sample is ok if every link of its path is; the others have the status of the first link that is not, and Pose{}.
/// Frames without the transform are missing. A rotation that is orthonormal to rounding error is kept to the bit;
/// another one up to kRecordedRotationError is replaced by the nearest rotation and counted. Throws InputError when no
/// transform fits, when a pose that is ok is not rigid, when the frames have no times and the options do not provide
/// for it, and when they have times and a rate is given.
ProbeTrack probe_track(const Sequence& sequence, const RecordingOptions& options = {});

/// probe_track()'s samples alone.
std::vector<PoseSample> probe_samples(const Sequence& sequence, std::string_view transform = {});

/// What was done besides moving, by the times of the frames that report it.
std::map<double, std::string> recorded_actions(const Sequence& sequence);

struct RecordedScan {
  Recording recording;
  std::vector<PoseSample> samples;
  std::optional<RecordedImages> images;  ///< empty without images, and where they are not of a form that is read
};

/// Reads a file once and finds its probe_track(). Keeps its header and samples; its images may have any size, and stay
/// in the file. Throws InputError.
RecordedScan read_recorded_scan(const std::filesystem::path& file, const RecordingOptions& options = {});

/// The same of a sequence that is parsed already; the recording has no digest and no images.
RecordedScan recorded_scan(const Sequence& sequence, const RecordingOptions& options = {});

}  // namespace insonate
