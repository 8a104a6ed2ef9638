#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "devices/recording.h"
#include "devices/sequence/sequence.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// The probe's poses among the transforms of a sequence, one sample a frame with the frame's own time.
///
/// `transform` names the one to take, with or without "Transform" at its end; when it is empty the first is taken that
/// the frames have of ProbeToPatient, ProbeToReference and ProbeToTracker. Where that ends in a frame other than
/// Patient and the sequence also knows the way on (TrackerToPatient, of each frame or once in the header), the two are
/// chained; else that frame is taken to be the patient's. The patient's frame is LPS; 3D Slicer shows RAS on the
/// screen, but what it saves in a sequence are the transforms as they came.
///
/// A sample is ok when all that was chained is; of others the pose is Pose{}, whatever the file holds: it may be zero.
/// Frames without the transform are missing. A rotation that is orthonormal to rounding error is kept to the bit,
/// another as far as why_not_rigid() lets it pass is made so. Throws InputError when no transform fits, or when one
/// that is ok is not rigid.
std::vector<PoseSample> probe_samples(const Sequence& sequence, std::string_view transform = {});

/// The name of the transform that probe_samples() takes, without "Transform" at its end. Throws as that does.
std::string probe_transform(const Sequence& sequence, std::string_view transform = {});

/// What was done besides moving, by the times of the frames that tell of it.
std::map<double, std::string> recorded_actions(const Sequence& sequence);

struct RecordedScan {
  Recording recording;
  std::vector<PoseSample> samples;
};

/// Reads a file once, parses it and picks. Keeps its header and samples; its images may have any size. Throws
/// InputError.
RecordedScan read_recorded_scan(const std::filesystem::path& file, std::string_view transform = {});

}  // namespace insonate
