#pragma once

#include <filesystem>

#include "devices/sequence/probe_samples.h"

namespace insonate {

/// Reads a recorded scan of either format: a sequence file, or a raw recording of what a tracker's device sent
/// (raw_recorder.h), which is passed through the tracker's parser. `file` may also be a tracker URI, `replay:FILE` or
/// `raw:FILE`.
/// @param options  for a sequence file; see probe_track()
/// Throws InputError, also if a transform is requested from a file that has none.
RecordedScan read_log(const std::filesystem::path& file, const RecordingOptions& options = {});

/// Returns whether a file begins like a raw recording. Throws InputError if it is not a file.
bool is_raw_log(const std::filesystem::path& file);

/// Throws InputError if the samples are a sensor's: without a calibration they do not give the probe's pose.
void check_is_of_probe(const Recording& recording);

/// Throws InputError if the times of the samples are assumed. Callers that score the samples use it.
void check_has_times(const Recording& recording);

}  // namespace insonate
