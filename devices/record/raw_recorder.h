#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "devices/live/raw_source.h"
#include "devices/record/append_only.h"
#include "devices/tracker.h"
#include "sim/core/pose.h"

namespace insonate {

/// Records what a tracker's device sends, byte for byte. `raw:FILE` replays the file to the same samples, and the file
/// shows what a device really sends.
///
/// The file is text, one event per line. It is only appended to, and each event is passed to the operating system at
/// once:
///
///     insonate raw 1
///     tracker hydra:A1?handset=2
///     start 1 0 0 0 1 0 0 0 1 10 -90 40
///     open 12.25 1532:0300
///     read 12.254 0100340002000101...
///     read 12.274
///     silent 12.8
///
/// `tracker` is the tracker's URI. `start` is its start pose (TrackerContext::start: the rotation's columns, then the
/// translation in mm). `open` has the USB numbers of the opened device, 0000:0000 if it has none. `read` has the bytes
/// of one read as hexadecimal digits, none if it timed out. `silent` stands for a published sample `missing`. Times are
/// seconds on the tracker's clock, with the fewest digits that give the same number again.
///
/// If the file cannot be written any more, recording ends and problem() returns the reason; the tracker continues.
class RawRecorder : public RawTap {
public:
  /// Throws InputError if the file already exists or cannot be created.
  RawRecorder(const std::filesystem::path& file, std::string_view uri, const Pose& start);

  void opened(const AttachedDevice& device, double time_s) noexcept override;
  void came(Bytes bytes, double time_s) noexcept override;
  void silent(double time_s) noexcept override;

  /// Returns why recording has ended, as a sentence; empty while it works. Any thread may call it.
  std::string problem() const;
  const std::filesystem::path& file() const { return file_.path(); }

private:
  void append(std::string_view text) noexcept;

  AppendOnlyFile file_;
  mutable std::mutex mutex_;
  std::string problem_;
};

/// Throws InputError if the tracker of `uri` has no device whose bytes can be recorded. Call it before the tracker's
/// first poll.
void check_sends_bytes(Tracker& tracker, std::string_view uri);

/// Records what the tracker of `uri` receives, from its first poll on. Call it before that. Throws InputError as
/// check_sends_bytes() and RawRecorder do.
std::shared_ptr<const RawRecorder> record_raw(Tracker& tracker, const std::filesystem::path& file, std::string_view uri,
                                              const Pose& start = {});

}  // namespace insonate
