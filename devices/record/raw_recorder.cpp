#include "devices/record/raw_recorder.h"

#include <cstdio>

#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

std::string head(std::string_view uri, const Pose& start) {
  std::string text = "insonate raw 1\ntracker " + std::string(uri) + "\nstart";
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) text += " " + exact_text(start.rotation[column][row]);
  for (int axis = 0; axis < 3; ++axis) text += " " + exact_text(start.translation[axis]);
  return text + "\n";
}

}  // namespace

RawRecorder::RawRecorder(const std::filesystem::path& file, std::string_view uri, const Pose& start) : file_(file) {
  file_.append(head(uri, start));
}

void RawRecorder::opened(const AttachedDevice& device, double time_s) noexcept {
  char numbers[16];
  std::snprintf(numbers, sizeof numbers, "%04x:%04x", unsigned{device.vendor}, unsigned{device.product});
  append("open " + exact_text(time_s) + " " + numbers + "\n");
}

void RawRecorder::came(Bytes bytes, double time_s) noexcept {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "read " + exact_text(time_s);
  if (!bytes.empty()) text += ' ';
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  append(text += '\n');
}

void RawRecorder::silent(double time_s) noexcept {
  append("silent " + exact_text(time_s) + "\n");
}

std::string RawRecorder::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

void RawRecorder::append(std::string_view text) noexcept {
  const std::lock_guard lock(mutex_);
  if (!problem_.empty()) return;
  try {
    file_.append(text);
  } catch (const InputError& error) {
    problem_ = error.what();
  }
}

void check_sends_bytes(Tracker& tracker, std::string_view uri) {
  if (!tracker.record_raw(nullptr))
    throw InputError("tracker '" + std::string(uri) + "'", "", "it has no device that sends bytes",
                     "record its samples instead, with --record");
}

std::shared_ptr<const RawRecorder> record_raw(Tracker& tracker, const std::filesystem::path& file, std::string_view uri,
                                              const Pose& start) {
  check_sends_bytes(tracker, uri);
  auto recorder = std::make_shared<RawRecorder>(file, uri, start);
  tracker.record_raw(recorder);
  return recorder;
}

}  // namespace insonate
