#include "devices/calibrated_tracker.h"

#include <algorithm>
#include <stdexcept>

#include "devices/filter/sample_filters.h"
#include "devices/tracker_uri.h"
#include "sim/core/digest.h"
#include "sim/core/input_error.h"

namespace insonate {

TrackerIdentity tracker_identity(std::string_view uri) {
  const TrackerUri parsed = parse_tracker_uri(uri);
  const bool recorded = parsed.scheme == "replay" || parsed.scheme == "raw";
  if (recorded) return {parsed.scheme, ""};
  const char* const part = parsed.options.contains("handset") ? "handset" : "sensor";
  return {parsed.scheme, parsed.subject, int(parsed.number(part, 1, 1, 16))};
}

void check_can_be_calibrated(std::string_view uri) {
  constexpr std::string_view kPlaced[] = {"mouse", "spacemouse", "osvr"};
  const std::string scheme = parse_tracker_uri(uri).scheme;
  if (std::find(std::begin(kPlaced), std::end(kPlaced), scheme) != std::end(kPlaced))
    throw InputError("tracker '" + std::string(uri) + "'", "", "it moves the probe in the patient and has no sensor",
                     "leave the calibration out");
  if (scheme == "auto")
    throw InputError("tracker '" + std::string(uri) + "'", "", "a calibration belongs to one tracker, not to the best",
                     "name it, with its serial number if there are two of a kind");
}

std::string sensor_uri(std::string_view uri, bool filtered) {
  const TrackerUri parsed = parse_tracker_uri(uri);
  const bool places = parsed.scheme == "hydra" || parsed.scheme == "polhemus";
  std::string text(uri);
  if (!places || parsed.options.contains("raw")) return text;
  text += parsed.options.empty() ? "?raw=1" : "&raw=1";
  if (!filtered || parsed.options.contains("filter")) return text;
  FilterSettings filters = FilterSettings::usual();
  filters.distortion = parsed.options.contains("distortion");
  return text + "&filter=" + to_string(filters);
}

Calibration calibration_to_go_on(const std::filesystem::path& file, const TrackerIdentity& tracker) {
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

CalibratedTracker::CalibratedTracker(std::unique_ptr<Tracker> sensor, Calibration calibration, const std::string& name)
    : Tracker(sensor->state().name + ", calibrated"), sensor_(std::move(sensor)), calibration_(std::move(calibration)) {
  if (!why_incomplete(calibration_).empty()) throw std::invalid_argument("the calibration is not complete");
  if (!sensor_->recording()) return;
  recording_ = *sensor_->recording();
  recording_->transform += " through " + name + " (" + digest_of(to_toml(calibration_)) + ")";
}

void CalibratedTracker::collect(double now_s, std::vector<PoseSample>& samples) {
  const std::size_t before = samples.size();
  sensor_->poll(now_s, samples);
  for (std::size_t i = before; i < samples.size(); ++i)
    if (samples[i].status == PoseStatus::ok)
      samples[i].patient_from_probe = calibration_.patient_from_probe(samples[i].patient_from_probe);
}

}  // namespace insonate
