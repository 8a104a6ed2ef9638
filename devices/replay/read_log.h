#pragma once

#include <filesystem>

#include "devices/sequence/probe_samples.h"

namespace insonate {

/// A recorded scan, whichever way it was recorded: a sequence file, or what a tracker's device sent (raw_recorder.h),
/// which is played through its parser. `replay:FILE` and `raw:FILE` name the file as a tracker's URI does.
/// @param options  of a sequence file, see probe_track()
/// Throws InputError, also when a transform is asked for of a file that has none.
RecordedScan read_log(const std::filesystem::path& file, const RecordingOptions& options = {});

/// Whether a file begins as a raw recording. Throws InputError when it is no file.
bool is_raw_log(const std::filesystem::path& file);

/// Throws InputError when the samples are a sensor's, which say nothing of the probe before they are calibrated.
void check_is_of_probe(const Recording& recording);

/// Throws InputError if the times of the samples are assumed. Callers that score them use it.
void check_has_times(const Recording& recording);

}  // namespace insonate
