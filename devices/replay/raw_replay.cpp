#include "devices/replay/raw_replay.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "devices/live/raw_source.h"
#include "devices/live/sample_conditioner.h"
#include "devices/registry.h"
#include "devices/replay/replay_tracker.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "sim/image_headers/header_text.h"

namespace insonate {
namespace {

constexpr std::string_view kMagic = "insonate raw 1";
constexpr const char* kRecordAgain = "record it again";

std::optional<unsigned> digit_of(char c) {
  if (c >= '0' && c <= '9') return unsigned(c - '0');
  if (c >= 'a' && c <= 'f') return unsigned(c - 'a' + 10);
  return std::nullopt;
}

std::optional<std::vector<std::uint8_t>> bytes_of(std::string_view digits) {
  if (digits.size() % 2 != 0) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const auto high = digit_of(digits[i]), low = digit_of(digits[i + 1]);
    if (!high || !low) return std::nullopt;
    bytes.push_back(std::uint8_t(*high << 4 | *low));
  }
  return bytes;
}

/// "1532:0300"
std::optional<AttachedDevice> device_of(std::string_view numbers) {
  if (numbers.size() != 9 || numbers[4] != ':') return std::nullopt;
  const auto vendor = bytes_of(numbers.substr(0, 4)), product = bytes_of(numbers.substr(5));
  if (!vendor || !product) return std::nullopt;
  AttachedDevice device;
  device.vendor = std::uint16_t((*vendor)[0] << 8 | (*vendor)[1]);
  device.product = std::uint16_t((*product)[0] << 8 | (*product)[1]);
  device.path = "its recording";
  return device;
}

std::optional<Pose> pose_of(const std::vector<std::string_view>& numbers) {
  if (numbers.size() != 12) return std::nullopt;
  Pose pose;
  for (std::size_t i = 0; i < 12; ++i) {
    const auto number = to_number<double>(numbers[i]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    (i < 9 ? pose.rotation[int(i / 3)] : pose.translation)[int(i % 3)] = *number;
  }
  if (why_not_rigid(pose.matrix())) return std::nullopt;
  return pose;
}

class Replay {
public:
  Replay(std::string_view bytes, const std::string& file) : rest_(bytes), file_(file) {}

  RawScan run() {
    if (next_line() != kMagic)
      fail("it does not begin with '" + std::string(kMagic) + "'",
           "name a file that --record-raw has written, or write 'replay:' before a sequence file");
    scan_.tracker = after("tracker ");
    const auto start = pose_of(words(after("start ")));
    if (!start) fail("'start' is not followed by the 12 numbers of a pose", kRecordAgain);
    make_source(*start);
    while (more()) event(next_line());
    if (scan_.samples.empty()) {
      line_ = 0;
      fail("nothing in it became a sample", kRecordAgain);
    }
    return std::move(scan_);
  }

private:
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw InputError(file_, line_ == 0 ? "" : "line " + std::to_string(line_), problem, remedy);
  }

  /// Returns whether there is another complete line.
  bool more() const { return rest_.find('\n') != std::string_view::npos; }

  std::string_view next_line() {
    const std::size_t end = rest_.find('\n');
    ++line_;
    if (end == std::string_view::npos) fail("the recording ends in its first lines", kRecordAgain);
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return line;
  }

  std::string_view after(std::string_view word) {
    const std::string_view line = next_line();
    if (!line.starts_with(word)) fail(quoted(line) + " does not begin with '" + std::string(word) + "'", kRecordAgain);
    return line.substr(word.size());
  }

  void make_source(const Pose& start) {
    TrackerContext context;
    context.start = start;
    line_ = 2;
    try {
      TrackerUri uri = parse_tracker_uri(scan_.tracker);
      conditioner_ = SampleConditioner(take_filter_options(uri));
      source_ = make_raw_source(uri, context);
    } catch (const InputError& error) {
      fail(std::string("its tracker cannot be made again (") + error.what() + ")", kRecordAgain);
    }
    line_ = 3;
  }

  void event(std::string_view line) {
    const std::vector<std::string_view> parts = words(line);
    const auto time_s = parts.size() >= 2 ? to_number<double>(parts[1]) : std::nullopt;
    if (!time_s || !std::isfinite(*time_s)) fail(quoted(line) + " is not an event with its time", kRecordAgain);
    if (*time_s < last_s_) fail("its time lies before that of the line before it", kRecordAgain);
    last_s_ = *time_s;
    if (parts[0] == "open" && parts.size() == 3)
      open(parts[2], *time_s);
    else if (parts[0] == "read" && parts.size() <= 3)
      read(parts.size() == 3 ? parts[2] : std::string_view(), *time_s);
    else if (parts[0] == "silent" && parts.size() == 2)
      publish(silence_at(*time_s));
    else
      fail(quoted(line) + " is none of 'open TIME DEVICE', 'read TIME BYTES' and 'silent TIME'", kRecordAgain);
  }

  void open(std::string_view numbers, double time_s) {
    const auto device = device_of(numbers);
    if (!device) fail(quoted(numbers) + " are not USB numbers, as in '1532:0300'", kRecordAgain);
    open_ = source_->replay_open(*device, time_s);
    if (!open_) fail("a device " + std::string(numbers) + " is none of '" + scan_.tracker + "'", kRecordAgain);
  }

  void read(std::string_view digits, double time_s) {
    const auto bytes = bytes_of(digits);
    if (!bytes) fail("what was read is not in pairs of hexadecimal digits", kRecordAgain);
    if (!open_) fail("something is read, but no device is open", kRecordAgain);
    LiveBatch batch;
    try {
      source_->replay_read(*bytes, time_s, batch);
    } catch (const SourceGone&) {
      open_ = false;
    }
    for (const ProbeSample& sample : batch.samples) publish(sample);
  }

  void publish(ProbeSample sample) {
    conditioner_.apply(sample, source_->origin());
    scan_.samples.push_back(sample);
  }

  std::string_view rest_;
  const std::string& file_;
  std::size_t line_ = 0;
  double last_s_ = -std::numeric_limits<double>::infinity();
  std::unique_ptr<RawSource> source_;
  bool open_ = false;
  SampleConditioner conditioner_;
  RawScan scan_;
};

}  // namespace

RawScan parse_raw(std::string_view bytes, const std::string& file) {
  return Replay(bytes, file).run();
}

bool is_raw_recording(std::string_view bytes) {
  return bytes.starts_with(kMagic);
}

RecordedScan read_raw_scan(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  RawScan raw = parse_raw(bytes, file.string());
  RecordedScan scan;
  scan.recording.file = file.filename().string();
  scan.recording.digest = digest_of(bytes);
  scan.recording.transform = "reports of " + raw.tracker;
  scan.recording.of_sensor = parse_tracker_uri(raw.tracker).flag("raw", false);
  scan.samples = std::move(raw.samples);
  return scan;
}

std::unique_ptr<Tracker> open_raw(const TrackerUri& uri, const TrackerContext&) {
  const ReplayTracker::Options options = replay_options(uri, {"speed", "loop"});
  RecordedScan scan = read_raw_scan(uri.subject);
  return std::make_unique<ReplayTracker>("raw replay of " + scan.recording.file, std::move(scan.samples), options,
                                         scan.recording);
}

}  // namespace insonate
