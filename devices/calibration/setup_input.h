#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "devices/calibration/calibration.h"

// Input for the set-up besides the tracker: the patient's landmarks and the probe's drawing.

namespace insonate {

/// Points to touch on the mannequin, in the order in which the set-up asks for them.
struct LandmarkList {
  std::string patient;
  std::vector<LandmarkPair> landmarks;  ///< touched_mm is not known yet
};

/// Reads a TOML file with `patient`, and for each landmark `[[landmark]]` with `name`, `ct_mm` (LPS) and `held_out`
/// (true for those that check the fit). assets/calibration/abdomen.toml is the built-in patient's. Throws InputError,
/// also if there are fewer than kMinLandmarks to fit, none to check, or more than 64, or if two have the same name.
LandmarkList read_landmark_list(const std::filesystem::path& file);

/// The probe's drawing in the frame of the sensor's mount, whose axes are those of the sensor maker's drawing.
struct ProbeDrawing {
  std::string name;
  FacePoints face;
  std::optional<glm::dvec3> tip_mm;  ///< the tip for pivoting
};

/// Reads a TOML file with `name`, `middle_mm`, `marker_end_mm`, `other_end_mm`, `tail_mm` and optionally `tip_mm`.
/// Throws InputError.
ProbeDrawing read_probe_drawing(const std::filesystem::path& file);

/// Largest distance from the drawing's tip to the one found by pivoting. A larger distance means another mount or other
/// axes.
inline constexpr double kMaxTipOff_mm = 10;

/// Returns the face from the drawing. If a tip was both drawn and found by pivoting, the face is shifted by their
/// difference, because a glued sensor is usually aligned better than it is positioned. Refused if the difference is
/// above kMaxTipOff_mm, or where fit_face() refuses.
Outcome<FaceSetup> face_from_drawing(const ProbeDrawing& drawing, const std::optional<TipFit>& tip);

}  // namespace insonate
