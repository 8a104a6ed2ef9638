#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "devices/calibration/calibration.h"
#include "devices/sequence/probe_samples.h"
#include "devices/tracker.h"

namespace insonate {

/// What a calibration calls the tracker of a URI: its kind, what the URI names (a serial number, a host), and its
/// option `sensor` or `handset`. Of a recording nothing but the kind, as a file's name says nothing of the tracker that
/// it came from. Throws InputError when the URI is none.
TrackerIdentity tracker_identity(std::string_view uri);

/// Whether a URI names a tracker as a lab's own set-up may be kept for it: a device whose sensor sits on a probe. A
/// recording or a made-up hand is another one each time.
bool is_a_labs_own(std::string_view uri);

/// Throws InputError for a URI whose tracker places the probe in the patient by itself, such as 'mouse:'.
void check_can_be_calibrated(std::string_view uri);

/// The tracker of a URI as its sensor tells of itself, not placed on the patient: as it comes, to calibrate it, or
/// through the filters, to scan with it, unless the URI says itself which.
std::string sensor_uri(std::string_view uri, bool filtered);

/// What a set-up of a tracker goes on with: the file's calibration, or an empty one when there is no file. Throws
/// InputError when the file is unusable or another tracker's.
Calibration calibration_to_go_on(const std::filesystem::path& file, const TrackerIdentity& tracker);

/// A recorded scan of a sensor's poses as the probe's in the patient. `name` is the calibration's, for the scan's
/// provenance. Throws std::invalid_argument when the calibration is not complete.
RecordedScan calibrated(RecordedScan scan, const Calibration& calibration, const std::string& name);

/// A tracker whose samples hold the pose of its sensor, and which so becomes one of the probe's in the patient. Times,
/// statuses and buttons stay as they are.
class CalibratedTracker : public Tracker {
public:
  /// @param name  of the calibration, for the state and a recording's provenance
  /// Throws std::invalid_argument when the calibration is not complete.
  CalibratedTracker(std::unique_ptr<Tracker> sensor, Calibration calibration, const std::string& name);

  const Recording* recording() const override { return recording_ ? &*recording_ : nullptr; }
  bool repeats() const override { return sensor_->repeats(); }
  bool live() const override { return sensor_->live(); }
  bool record_raw(const std::shared_ptr<RawTap>& tap) override { return sensor_->record_raw(tap); }
  double clock_s(double now_s) const override { return sensor_->clock_s(now_s); }

protected:
  void collect(double now_s, std::vector<PoseSample>& samples) override;
  std::optional<double> progress() const override { return sensor_->state().progress; }
  std::string problem() const override { return sensor_->state().problem; }
  std::uint64_t dropped() const override { return sensor_->state().dropped; }

private:
  std::unique_ptr<Tracker> sensor_;
  Calibration calibration_;
  std::optional<Recording> recording_;
};

}  // namespace insonate
