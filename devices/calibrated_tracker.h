#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "devices/calibration/calibration.h"
#include "devices/sensor_tracker.h"
#include "devices/sequence/probe_samples.h"
#include "devices/tracker.h"

namespace insonate {

/// Returns the identity under which a calibration names the tracker of `uri`: its kind, the subject of the URI (a
/// serial number or a host), and its option `sensor` or `handset`. For a recording it returns the kind alone, because a
/// file's name does not identify the tracker that was recorded. Throws InputError if `uri` is not a tracker URI.
TrackerIdentity tracker_identity(std::string_view uri);

/// Returns whether a lab can keep a set-up for the tracker of `uri`: true for a device whose sensor sits on a probe. A
/// recording or a synthetic hand can be a different one each time.
bool can_store_setup(std::string_view uri);

/// Throws InputError if the tracker of `uri` places the probe in the patient by itself, such as 'mouse:', or is
/// 'auto:', which is not one particular tracker.
void check_can_be_calibrated(std::string_view uri);

/// Returns `uri` changed so that the tracker reports the raw pose of its sensor, not placed in the patient. The samples
/// are unfiltered, to calibrate with them, or `filtered`, to scan with them. Options that the URI sets itself stay.
std::string sensor_uri(std::string_view uri, bool filtered);

/// Returns the calibration from which the set-up of `tracker` continues: the one in `file`, or an empty one if there is
/// no such file. Throws InputError if the file is unusable or belongs to another tracker.
Calibration calibration_to_continue(const std::filesystem::path& file, const TrackerIdentity& tracker);

/// Converts a recorded scan of sensor poses to one of probe poses in the patient. `name` is the calibration's name, for
/// the scan's provenance. Throws std::invalid_argument if the calibration is not complete.
RecordedScan calibrated(RecordedScan scan, const Calibration& calibration, const std::string& name);

/// Turns a tracker of sensor poses into a tracker of probe poses in the patient. Times, statuses and buttons stay as
/// they are.
class CalibratedTracker : public Tracker {
public:
  /// @param name  the calibration's name, for the state and a recording's provenance
  /// Throws std::invalid_argument if the calibration is not complete.
  CalibratedTracker(SensorTracker sensor, Calibration calibration, const std::string& name);

  const Recording* recording() const override { return recording_ ? &*recording_ : nullptr; }
  bool repeats() const override { return sensor_.tracker().repeats(); }
  bool live() const override { return sensor_.tracker().live(); }
  RehearsalTracker* rehearsed() override { return sensor_.tracker().rehearsed(); }
  bool record_raw(const std::shared_ptr<RawTap>& tap) override { return sensor_.tracker().record_raw(tap); }
  double clock_s(double now_s) const override { return sensor_.tracker().clock_s(now_s); }

protected:
  void collect(double now_s, std::vector<ProbeSample>& samples) override;
  std::optional<double> progress() const override { return sensor_.tracker().state().progress; }
  std::string problem() const override { return sensor_.tracker().state().problem; }
  std::uint64_t dropped() const override { return sensor_.tracker().state().dropped; }

private:
  SensorTracker sensor_;
  Calibration calibration_;
  std::optional<Recording> recording_;
  std::vector<SensorSample> polled_;  ///< kept to reuse its memory
};

}  // namespace insonate
