#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/anatomy.h"
#include "scenarios/cases/body.h"
#include "sim/phantom/phantom.h"
#include "sim/tissue/tissue.h"

namespace insonate {

/// The least that a view must show of its targets: this share of their area in its fan is clear of bone and gas, and
/// this share of their section in its plane is visible.
inline constexpr double kMinClear = 0.5, kMinSection = 0.25;

/// The result of suggest_views().
struct SuggestedViews {
  std::vector<ReferenceView> views;
  std::vector<std::string> notes;  ///< one sentence per view: how much it shows, or why it is left out
};

/// Returns views for the curvilinear probe that follow from the anatomy and have an acoustic window
/// (acoustic_window.h):
///   liver_long, liver_short, ...          the plane along the organ's long axis, or perpendicular to it, through its
///                                         centre; for bladder and prostate sagittal and transverse
///   aorta_transverse_l2, ..., aorta_long  perpendicular to the vessel at each of its levels, and along it at the level
///                                         that shows best
///   hepatorenal, splenorenal              along the kidney's long axis through the recess
/// A view below kMinClear or kMinSection is left out. A view's landmarks are the case's landmarks that belong to
/// its targets and lie in its picture. The case must have its volumes, labels and landmarks. Every returned view passes
/// ViewMeter's checks.
SuggestedViews suggest_views(const Case& subject, const Anatomy& anatomy, const BodyMask& body,
                             const TissueTable& tissues, const Progress& progress = {});

}  // namespace insonate
