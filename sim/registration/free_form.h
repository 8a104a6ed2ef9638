#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <functional>
#include <vector>

#include "sim/registration/free_form_field.h"
#include "sim/registration/registration.h"
#include "sim/registration/tracked_sweep.h"
#include "sim/tissue/acoustic_volume.h"

namespace insonate {

/// How a deformation is fitted.
struct FreeFormSettings {
  double spacing_mm = 25;        ///< between control points, 8 to 100
  double smoothness_mm2 = 1000;  ///< weight of FreeFormField::bending_energy(), mm^2, 0 to 1e6; see fit_free_form()
  /// The least FreeFormField::least_jacobian() of a field that is accepted, above 0 to 1. At 0.2, no tissue is pressed
  /// to less than a fifth of its volume. That leaves room for the points between those that are checked, where even
  /// random fields do not fall below 0.1.
  double least_jacobian = 0.2;
  WeinSettings wein = registration_settings();  ///< with patches; the image's size is not used
  int rounds = 12;                              ///< most of them, 1 to 100
  int batch = 512;                              ///< about how many images per call, 1 to 100000
  std::function<void()> between_calls;          ///< as RegistrationSettings::between_calls
};

/// Images of a sweep that a deformation needs: half of them judge it.
inline constexpr std::size_t kMinFreeFormImages = 4;
/// Control points of a deformation. Time and memory of a step rise faster than their number.
inline constexpr std::size_t kMaxControlPoints = 10000;

/// One evaluation of a deformation.
struct FreeFormEvaluation {
  double similarity = 0;          ///< of the fitted images
  double bending_energy_mm2 = 0;  ///< mm^-2, of the field that the evaluation varies
  bool varied = false;            ///< control points are varied for the derivatives; otherwise a step is tried
};

/// The result of the fit. The map from the sweep to the CT is p -> ct_from_sweep field.at(p).
struct FreeFormRegistration {
  FreeFormField field;                             ///< in the sweep's frame; 0 everywhere unless is_improved()
  double least_jacobian = 1;                       ///< of the field that was fitted
  double most_mm = 0;                              ///< largest displacement of a target point by that field
  double fitted_before = 0, fitted_after = 0;      ///< similarity of the images of even index
  double held_out_before = 0, held_out_after = 0;  ///< of the images of odd index
  double held_out_error = 0;                       ///< standard error of held_out_after - held_out_before
  int rounds = 0;
  std::vector<FreeFormEvaluation> evaluations;
  double seconds = 0;

  /// Returns whether the images that were not fitted became more similar, by more than chance would make them: twice
  /// the standard error. A fit of what model W leaves out makes them more similar too, also where nothing has moved.
  bool is_improved() const { return held_out_after - held_out_before > 2 * held_out_error; }
};

/// Fits a smooth deformation to a sweep that is registered already, so that
///     LC2 over the patches of the images - smoothness_mm2 * bending energy
/// becomes largest (Rueckert 1999, with LC2 in place of mutual information). Every second image is fitted. The others
/// judge: a field with enough control points always makes the fitted images more similar.
///
/// Each round varies every control point along each axis by both signs. A patch depends on the 64 control points around
/// it. So one evaluation varies every fourth control point along each axis, and each patch shows what its own one does:
/// 384 evaluations are enough for any grid. A Newton step follows, with the curvature of each control point and,
/// between control points, that of the splines' products. Its length is the best of several. A step whose field
/// presses tissue beyond FreeFormSettings::least_jacobian is not taken. Rounds end when a step gains little.
///
/// Needs an OpenGL context. The result depends on no thread's speed. Throws what gl::WeinSimulator throws, and
/// std::invalid_argument for settings without patches, fewer than kMinFreeFormImages, or more than
/// kMaxControlPoints.
/// @param ct_from_sweep  the map so far
FreeFormRegistration fit_free_form(const AcousticVolume& volume, const TrackedSweep& sweep,
                                   const glm::dmat4& ct_from_sweep, const FreeFormSettings& settings);

}  // namespace insonate
