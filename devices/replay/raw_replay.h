#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "devices/sequence/probe_samples.h"
#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// The samples that a raw recording's tracker published when it was recorded (raw_recorder.h describes the format). The
/// bytes pass through the same parser, source and filters again, with the recorded times.
struct RawScan {
  std::string tracker;  ///< URI of the recorded tracker
  std::vector<ProbeSample> samples;
};

/// Parses a recording. The result depends on the bytes alone; `file` names them in error messages. An incomplete last
/// line, as after a crash, is ignored. Throws InputError if the bytes are not a raw recording, if they are damaged, or
/// if they give no sample.
RawScan parse_raw(std::string_view bytes, const std::string& file);

/// Returns whether the bytes begin like a raw recording.
bool is_raw_recording(std::string_view bytes);

/// Reads and parses a file. Throws InputError as parse_raw() does, and for a file above 1 GiB.
RecordedScan read_raw_scan(const std::filesystem::path& file);

/// Opens raw:FILE[?speed=2&loop=1]. Throws InputError, also for a file above 1 GiB.
std::unique_ptr<Tracker> open_raw(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
