#include "devices/replay/read_log.h"

#include <array>
#include <fstream>
#include <string>

#include "devices/replay/raw_replay.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/files/held_files.h"

namespace insonate {

bool is_raw_log(const std::filesystem::path& file) {
  if (is_held(file)) return false;
  check_is_file(file);
  std::array<char, 64> bytes{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), std::streamsize(bytes.size()));
  return is_raw_recording({bytes.data(), std::size_t(stream.gcount())});
}

RecordedScan read_log(const std::filesystem::path& named, const RecordingOptions& options) {
  const std::string text = named.string();
  const bool as_raw = text.starts_with("raw:"), as_replay = text.starts_with("replay:");
  const std::filesystem::path file = as_raw ? text.substr(4) : as_replay ? text.substr(7) : text;
  if (!as_raw && (as_replay || !is_raw_log(file))) return read_recorded_scan(file, options);
  if (!options.transform.empty())
    throw InputError(file.string(), "--transform", "what a tracker's device sent has no transforms to choose from",
                     "leave it out");
  return read_raw_scan(file);
}

void check_is_of_probe(const Recording& recording) {
  if (recording.of_sensor)
    throw InputError(
        recording.file, "", "it holds the poses of the tracker's sensor, and nobody says where the probe is",
        "give the calibration that it was recorded with, as insonate and insonate-score take it: --calibration "
        "FILE");
}

void check_has_times(const Recording& recording) {
  if (recording.assumed_rate_hz)
    throw InputError(recording.file, "", "its frames have no Timestamp, and an exam is not scored by an assumed rate",
                     "record it again with times, or look at it without a scenario");
}

}  // namespace insonate
