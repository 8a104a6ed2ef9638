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

/// Writes down what a tracker's device sends, byte for byte, for `raw:FILE` to give the same samples again, and for who
/// wants to see what a device really sends.
///
/// The file is text, a line for each event, only ever appended to; what happened is the operating system's at once:
///
///     insonate raw 1
///     tracker hydra:A1?handset=2
///     start 1 0 0 0 1 0 0 0 1 10 -90 40
///     open 12.25 1532:0300
///     read 12.254 0100340002000101...
///     read 12.274
///     silent 12.8
///
/// `tracker` is the tracker's URI, `start` the pose that it began with (TrackerContext::start: the rotation's columns
/// and the translation, mm). `open` has the USB numbers of the device that was opened, 0000:0000 where there is none;
/// `read` the bytes of one read, in hexadecimal digits, none when nothing came in time; `silent` stands for a sample
/// `missing` that was handed over. Times are seconds on the tracker's clock in the fewest digits that give the same
/// number again.
///
/// Where the file cannot be written on, recording ends and problem() says why; the tracker goes on.
class RawRecorder : public RawTap {
public:
  /// Throws InputError when the file is there already or cannot be made.
  RawRecorder(const std::filesystem::path& file, std::string_view uri, const Pose& start);

  void opened(const AttachedDevice& device, double time_s) noexcept override;
  void came(Bytes bytes, double time_s) noexcept override;
  void silent(double time_s) noexcept override;

  /// Why nothing is recorded any more, as a sentence; empty while all is well. By any thread.
  std::string problem() const;
  const std::filesystem::path& file() const { return file_.path(); }

private:
  void append(std::string_view text) noexcept;

  AppendOnlyFile file_;
  mutable std::mutex mutex_;
  std::string problem_;
};

/// Throws InputError when the tracker of `uri` has no device whose bytes could be recorded. To be called before its
/// first poll.
void check_sends_bytes(Tracker& tracker, std::string_view uri);

/// Records what the tracker of `uri` gets, from its first poll on; to be called before that. Throws InputError as
/// check_sends_bytes() and RawRecorder do.
std::shared_ptr<const RawRecorder> record_raw(Tracker& tracker, const std::filesystem::path& file, std::string_view uri,
                                              const Pose& start = {});

}  // namespace insonate
