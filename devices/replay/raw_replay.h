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

/// The samples that a raw recording's tracker handed over when it was recorded (raw_recorder.h has the format): the
/// bytes go through the same parser, policy and filters again, at the times that they came.
struct RawScan {
  std::string tracker;  ///< URI of what was recorded
  std::vector<PoseSample> samples;
};

/// A pure function of the bytes; `file` names them in messages. A last line that is cut, as by a crash, is left out.
/// Throws InputError when they are no such recording, or damaged, or nothing of it became a sample.
RawScan parse_raw(std::string_view bytes, const std::string& file);

/// Whether bytes begin as such a recording.
bool is_raw_recording(std::string_view bytes);

/// Throws InputError as parse_raw() does, and of a file above 1 GiB.
RecordedScan read_raw_scan(const std::filesystem::path& file);

/// raw:FILE[?speed=2&loop=1]. Throws InputError; of a file above 1 GiB too.
std::unique_ptr<Tracker> open_raw(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
