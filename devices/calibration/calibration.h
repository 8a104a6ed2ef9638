#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/calibration/axes.h"
#include "devices/calibration/face.h"
#include "devices/calibration/lag.h"
#include "devices/calibration/registration.h"
#include "devices/calibration/tip.h"

namespace insonate {

/// Identifies a sensor of a tracker: the scheme of the tracker's URI, its serial number if the URI has one, and the
/// number of the sensor or handset. Each sensor has its own placement on the probe.
struct TrackerIdentity {
  std::string kind;
  std::string serial;
  int sensor = 1;  ///< from 1
  bool operator==(const TrackerIdentity&) const = default;
  std::string words() const;  ///< "hydra, serial 1234, sensor 2"
};

/// The largest file of a set-up: a calibration, landmarks or a drawing.
inline constexpr std::size_t kMaxSetupBytes = 1u << 20;

/// A result of a set-up step and the time when it was made, in seconds since 1970 (UTC).
template <typename T>
struct Dated {
  T value;
  std::int64_t made_s = 0;
};

/// The result of the step "face".
struct FaceSetup {
  FaceFit fit;
  std::string method;     ///< "touch" or "drawing"
  double tip_off_mm = 0;  ///< distance from the drawing's tip to the one found by pivoting; 0 if touched
};

/// The result of the step "landmarks".
struct MannequinSetup {
  std::string patient;  ///< the patient to whom the landmarks belong
  Pose ct_from_mannequin;
  /// The mannequin's frame is the tracker's frame at the time when the landmarks were first touched. If the tracker's
  /// base or the mannequin has been moved since then, this is not the identity.
  Pose mannequin_from_tracker;
  double accuracy_mm = 0, residual_mm = 0, worst_mm = 0;  ///< of the last touched landmarks; see Registration
  std::string worst;
  std::vector<LandmarkPair> landmarks;  ///< touched_mm in the mannequin's frame
};

/// Everything that converts the poses of a tracker's sensor to the probe's in the patient. The result of a step is
/// empty until the step has been made.
struct Calibration {
  TrackerIdentity tracker;
  std::optional<Dated<AxesFinding>> axes;
  std::optional<Dated<TipFit>> tip;
  std::optional<Dated<FaceSetup>> face;
  std::optional<Dated<MannequinSetup>> mannequin;
  std::optional<Dated<KnockLag>> lag;  ///< reported, not applied: samples keep their times

  /// Returns the tracker's pose with its axis signs corrected.
  Pose tracker_from_sensor(const Pose& raw) const { return axes ? axes->value.signs.apply(raw) : raw; }

  /// Returns ct_from_mannequin * mannequin_from_tracker * tracker_from_sensor(raw) * sensor_from_face. Requires face
  /// and mannequin: why_incomplete() must be empty.
  Pose patient_from_probe(const Pose& raw) const;
};

/// Returns the first missing step that a trainer requires, "face" or "landmarks"; empty if none is missing.
std::string why_incomplete(const Calibration& calibration);

/// Returns when the older of the two required steps was made, in seconds since 1970. Meaningful if why_incomplete() is
/// empty.
std::int64_t made_s(const Calibration& calibration);

/// A set-up older than this is checked again: sensors slip, mannequins are moved, and a week is the length of a course.
inline constexpr double kCalibrationDays = 7;

/// Returns warnings about a calibration, as sentences: that it is older than `days`, or that it belongs to another
/// tracker.
/// @param now_s  seconds since 1970
std::vector<std::string> calibration_warnings(const Calibration& calibration, const TrackerIdentity& tracker,
                                              std::int64_t now_s, double days = kCalibrationDays);

/// Returns the file's text (TOML; docs/calibration.md describes every key). parse_calibration() reads it back bit for
/// bit.
std::string to_toml(const Calibration& calibration);

/// Parses the text of a calibration file. Throws InputError if it differs from what to_toml() writes: missing or
/// unknown keys, numbers out of range, transforms that are not rigid, or steps whose required steps are missing.
Calibration parse_calibration(std::string_view text, const std::string& file);

/// Reads and parses a file. Throws InputError, also if the file has more than 1 MiB.
Calibration read_calibration(const std::filesystem::path& file);

/// Does the same for callers that need all required steps: also throws InputError if why_incomplete() names a missing
/// one.
Calibration read_complete_calibration(const std::filesystem::path& file);

/// Writes under a temporary name and renames the file. Throws InputError if that fails.
void write_calibration(const std::filesystem::path& file, const Calibration& calibration);

}  // namespace insonate
