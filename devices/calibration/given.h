#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "devices/calibration/calibration.h"

// What a person hands to the set-up beside the tracker: the patient's landmarks and the probe's drawing.

namespace insonate {

/// Places that are touched on the mannequin, in the order in which they are asked for.
struct LandmarkList {
  std::string patient;
  std::vector<LandmarkPair> landmarks;  ///< touched_mm is not known yet
};

/// A TOML file: `patient`, and for each landmark `[[landmark]]` with `name`, `ct_mm` (LPS) and `held_out` (true for
/// those that check the fit). assets/calibration/abdomen.toml is the built-in patient's. Throws InputError, also when
/// there are fewer than kLeastLandmarks to fit, none to check or more than 64, or when two have one name.
LandmarkList read_landmark_list(const std::filesystem::path& file);

/// The probe as it is drawn, in the frame of the sensor's mount: where the maker's drawing of the sensor has its axes.
struct ProbeDrawing {
  std::string name;
  FacePoints face;
  std::optional<glm::dvec3> tip_mm;  ///< of the point that pivots
};

/// A TOML file: `name`, `middle_mm`, `marker_end_mm`, `other_end_mm`, `tail_mm` and perhaps `tip_mm`. Throws
/// InputError.
ProbeDrawing read_probe_drawing(const std::filesystem::path& file);

/// How far the drawing's tip may lie from the one that pivoting found: more is another mount, or other axes.
inline constexpr double kMostTipOffMm = 10;

/// The face as it is drawn, and where a tip was both drawn and found by pivoting, shifted by the difference, as a
/// sensor is glued in straight sooner than in place. Refused when that difference is above kMostTipOffMm or as
/// fit_face() refuses.
Outcome<FaceSetup> face_from_drawing(const ProbeDrawing& drawing, const std::optional<TipFit>& tip);

}  // namespace insonate
