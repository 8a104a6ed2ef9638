#include "devices/calibrated_tracker.h"

#include <stdexcept>
#include <utility>

#include "devices/calibration/utc.h"
#include "devices/filter/sample_filters.h"
#include "devices/registry.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"

namespace insonate {

TrackerIdentity tracker_identity(std::string_view uri) {
  const TrackerUri parsed = parse_tracker_uri(uri);
  if (kind_of(parsed).poses == PosesOf::recording) return {parsed.scheme, ""};
  const char* const part = parsed.options.contains("handset") ? "handset" : "sensor";
  return {parsed.scheme, parsed.subject, int(parsed.number(part, 1, 1, 16))};
}

bool can_store_setup(std::string_view uri) {
  try {
    return kind_of(parse_tracker_uri(uri)).poses == PosesOf::sensor;
  } catch (const InputError&) {
    return false;  // opening it reports why
  }
}

void check_can_be_calibrated(std::string_view uri) {
  const PosesOf poses = kind_of(parse_tracker_uri(uri)).poses;
  if (poses == PosesOf::probe)
    throw InputError("tracker '" + std::string(uri) + "'", "", "it moves the probe in the patient and has no sensor",
                     "leave the calibration out");
  if (poses == PosesOf::any)
    throw InputError("tracker '" + std::string(uri) + "'", "", "a calibration belongs to one tracker, not to the best",
                     "name it, with its serial number if there are two of a kind");
}

std::string sensor_uri(std::string_view uri, bool filtered) {
  const TrackerUri parsed = parse_tracker_uri(uri);
  std::string text(uri);
  const TrackerKind& kind = kind_of(parsed);
  if (!kind.places_sensor || parsed.options.contains("raw")) return text;
  text += parsed.options.empty() ? "?raw=1" : "&raw=1";
  if (!filtered || !kind.make || parsed.options.contains("filter")) return text;
  FilterSettings filters = FilterSettings::usual();
  filters.distortion = parsed.options.contains("distortion");
  return text + "&filter=" + to_string(filters);
}

Calibration calibration_to_continue(const std::filesystem::path& file, const TrackerIdentity& tracker) {
  Calibration calibration;
  calibration.tracker = tracker;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return calibration;
  calibration = read_calibration(file);
  if (calibration.tracker != tracker)
    throw InputError(file.string(), "[tracker]",
                     "it holds the calibration of another tracker (" + calibration.tracker.words() + ")",
                     "name another file for " + tracker.words());
  return calibration;
}

namespace {

void check_complete(const Calibration& calibration) {
  if (!why_incomplete(calibration).empty()) throw std::invalid_argument("the calibration is not complete");
}

/// "2026-03-01"
std::string day_of(const Calibration& calibration) {
  return why_incomplete(calibration).empty() ? utc_text(made_s(calibration)).substr(0, 10) : "";
}

Recording calibrated(Recording recording, const Calibration& calibration, const std::string& name) {
  recording.transform += " through " + name + " (" + digest_of(to_toml(calibration)) + ")";
  recording.of_sensor = false;
  return recording;
}

ProbeSample placed(const SensorSample& sample, const Calibration& calibration) {
  const bool usable = sample.status == PoseStatus::ok;
  return {sample.time_s,
          sample.status,
          usable ? calibration.patient_from_probe(sample.tracker_from_sensor) : sample.tracker_from_sensor,
          sample.buttons,
          sample.distortion,
          sample.rejected};
}

}  // namespace

RecordedScan calibrated(RecordedScan scan, const Calibration& calibration, const std::string& name) {
  check_complete(calibration);
  for (ProbeSample& sample : scan.samples) sample = placed(sensor_sample(sample), calibration);
  scan.recording = calibrated(std::move(scan.recording), calibration, name);
  return scan;
}

CalibratedTracker::CalibratedTracker(SensorTracker sensor, Calibration calibration, const std::string& name)
    : Tracker(sensor.tracker().state().name + ", calibrated " + day_of(calibration)),
      sensor_(std::move(sensor)),
      calibration_(std::move(calibration)) {
  check_complete(calibration_);
  if (const Recording* raw = sensor_.tracker().recording()) recording_ = calibrated(*raw, calibration_, name);
}

void CalibratedTracker::collect(double now_s, std::vector<ProbeSample>& samples) {
  polled_.clear();
  sensor_.poll(now_s, polled_);
  for (const SensorSample& sample : polled_) samples.push_back(placed(sample, calibration_));
}

}  // namespace insonate
