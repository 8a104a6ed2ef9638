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

/// Which sensor of which tracker: its URI's scheme, its serial number where it tells one, and which of its sensors or
/// handsets, as each sits on the probe in a way of its own.
struct TrackerIdentity {
  std::string kind;
  std::string serial;
  int sensor = 1;  ///< from 1
  bool operator==(const TrackerIdentity&) const = default;
  std::string words() const;  ///< "hydra, serial 1234, sensor 2"
};

/// A step of the set-up and when it was made, in seconds since 1970 (UTC).
template <typename T>
struct Dated {
  T value;
  std::int64_t made_s = 0;
};

struct FaceSetup {
  FaceFit fit;
  std::string method;     ///< "touch" or "drawing"
  double tip_off_mm = 0;  ///< how far the drawing's tip lay from the one found by pivoting; 0 when touched
};

struct MannequinSetup {
  std::string patient;  ///< whose landmarks they are
  Pose ct_from_mannequin;
  /// The mannequin's frame is the tracker's as it was when the landmarks were first touched. Where the tracker's base
  /// or the mannequin was moved since, this is no longer the identity.
  Pose mannequin_from_tracker;
  double accuracy_mm = 0, residual_mm = 0, worst_mm = 0;  ///< of the last time landmarks were touched: Registration
  std::string worst;
  std::vector<LandmarkPair> landmarks;  ///< touched_mm in the mannequin's frame
};

/// All that turns the poses of a tracker's sensor into the probe's in the patient. Each step is there once it was made.
struct Calibration {
  TrackerIdentity tracker;
  std::optional<Dated<AxesFinding>> axes;
  std::optional<Dated<TipFit>> tip;
  std::optional<Dated<FaceSetup>> face;
  std::optional<Dated<MannequinSetup>> mannequin;
  std::optional<Dated<KnockLag>> lag;  ///< told, not applied: samples keep their times

  /// What the tracker says with its axes put right.
  Pose tracker_from_sensor(const Pose& raw) const { return axes ? axes->value.signs.apply(raw) : raw; }

  /// ct_from_mannequin * mannequin_from_tracker * tracker_from_sensor(raw) * sensor_from_face. Needs face and
  /// mannequin: why_incomplete() is empty.
  Pose patient_from_probe(const Pose& raw) const;
};

/// The step that a trainer cannot do without and that is missing: "face" or "landmarks"; empty when none is.
std::string why_incomplete(const Calibration& calibration);

/// When the older of the two was made that a trainer cannot do without, in seconds since 1970. Meaningful when
/// why_incomplete() is empty.
std::int64_t made_s(const Calibration& calibration);

/// After so long a set-up is checked again: sensors slip and mannequins are moved, and a week is a course.
inline constexpr double kCalibrationDays = 7;

/// What a person should know before trusting it: that it is older than `days` or belongs to another tracker. Sentences.
std::vector<std::string> calibration_warnings(const Calibration& calibration, const TrackerIdentity& tracker,
                                              std::int64_t now_s, double days = kCalibrationDays);

/// The file's text (TOML; docs/calibration.md has every key). parse_calibration() reads it back to the same bits.
std::string to_toml(const Calibration& calibration);

/// Throws InputError for whatever is not as to_toml() writes it: keys that are missing or unknown, numbers out of
/// range, transforms that are not rigid, steps that rest on others that are not there.
Calibration parse_calibration(std::string_view text, const std::string& file);

/// Throws InputError, also when the file has more than 1 MiB.
Calibration read_calibration(const std::filesystem::path& file);

/// The same for who cannot do without a step: throws InputError as well when why_incomplete() names one.
Calibration read_complete_calibration(const std::filesystem::path& file);

/// Under a temporary name, then renamed. Throws InputError when that cannot be done.
void write_calibration(const std::filesystem::path& file, const Calibration& calibration);

}  // namespace insonate
