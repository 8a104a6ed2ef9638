#pragma once

#include <memory>

#include "devices/calibration/steps/setup_step.h"

// The steps that begin_setup_step() makes, each implemented in its own file.

namespace insonate {

/// Four straight moves, each between two marks.
std::unique_ptr<SetupStep> axes_step(const Calibration& base);
/// Pivoting between two marks.
std::unique_ptr<SetupStep> pivot_step(const Calibration& base);
/// A sharp fixed corner, touched with the tip and then with four places of the probe.
std::unique_ptr<SetupStep> face_step(const Calibration& base);
/// The face from its drawing; the user has nothing to do.
std::unique_ptr<SetupStep> drawn_face_step(const Calibration& base, const ProbeDrawing& drawing);
/// The mannequin's landmarks, touched with the tip.
std::unique_ptr<SetupStep> landmark_step(const Calibration& base, const LandmarkList& list);
/// The landmarks of the last set-up again, after the base or the mannequin was moved.
std::unique_ptr<SetupStep> moved_landmark_step(const Calibration& base);
/// Knocks on a key.
std::unique_ptr<SetupStep> lag_step(const Calibration& base);

/// Limit for a step that collects poses: a minute of the fastest tracker. It keeps a forgotten step from filling the
/// memory.
inline constexpr std::size_t kMaxStepPoses = 60000;

}  // namespace insonate
