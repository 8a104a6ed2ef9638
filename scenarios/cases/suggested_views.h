#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/anatomy.h"
#include "scenarios/cases/body.h"
#include "sim/model/tissue.h"
#include "sim/phantom/phantom.h"

namespace insonate {

/// What a view must show of its targets: of what its fan holds of them, this much clear of bone and gas, and of their
/// section in its plane this much.
inline constexpr double kLeastClear = 0.5, kLeastSection = 0.25;

struct SuggestedViews {
  std::vector<ReferenceView> views;
  std::vector<std::string> notes;  ///< a sentence for each view: how much it shows, or why it is not there
};

/// Views with the curvilinear probe that the anatomy gives and an acoustic window (acoustic_window.h) lets through:
///   liver_long, liver_short, ...          the plane along the organ's long axis, or square to it, through its centre;
///                                         of bladder and prostate sagittal and transverse
///   aorta_transverse_l2, ..., aorta_long  square to the vessel at each of its levels, and along it at the level that
///                                         shows best
///   hepatorenal, splenorenal              along the kidney's long axis through the recess
/// A view that would show less than kLeastClear and kLeastSection ask for is left out. A view's landmarks are those of
/// the case that belong to its targets and lie in its picture. The case has its volumes, labels and landmarks; every
/// view passes ViewMeter's checks.
SuggestedViews suggest_views(const Case& subject, const Anatomy& anatomy, const BodyMask& body,
                             const TissueTable& tissues, const Progress& progress = {});

}  // namespace insonate
