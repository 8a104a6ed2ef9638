#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "sim/core/pose.h"
#include "sim/model/beam.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/model/stored_speckle.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/coupling.h"
#include "sim/tissue/tissue.h"

namespace insonate {

/// The medium at a point, independent of its storage. The reference also takes fields given by a formula, against which
/// its own accuracy can be measured.
struct Medium {
  double hu = -1000;
  double echogenicity_db = -60;
};
using MediumField = std::function<Medium(const glm::dvec3& patient_mm)>;

/// Returns what sound meets where the field has `medium`, at distance r_mm from the face along the line. Nearer than
/// coupling_depth_mm() (sim/model/settings.h), water without echo takes the place of air.
Medium with_gel(const Medium& medium, double r_mm, double coupling_depth_mm);

/// Returns the trilinear field of a volume, with air outside. The volume must outlive it.
MediumField trilinear_field(const AcousticVolume& volume);

/// Returns the echo, or 0 if it is not above kMinEcho.
double heard(double echo);

/// Runs model S in double precision and plain loops, as the formulas of sim/model/stages.h read. Everything faster is
/// measured against it.
///
/// It shares with the shaders what sim/model and sim/probe provide, which has tests of its own: the tissue table, the
/// geometry of lines and pixels, the scatterers' lattice, the weights of the beam and the slice, the levels of noise
/// and clutter, and constants. Everything computed along lines and at pixels is written here a second time. The
/// arguments are not checked; they must be such as a simulator accepts (sim/imaging/simulator.h).
/// @param stored  a scattering volume that stands for the scatterers without waves; null for none
Stages<double> simulate_reference(const MediumField& field, const TissueTable& table, const Probe& probe,
                                  double depth_mm, const Settings& settings, const Pose& patient_from_probe,
                                  const StoredSpeckle* stored = nullptr);

/// Does the same for a probe in motion: each look has its own pose, and the frame before is mixed in
/// (Simulator::image_in_motion()). The stages up to f are those of the straight look.
/// @param of_looks      one pose per angle of look_angles() (sim/model/compounding.h)
/// @param frame_before  Stages::shown of it, of the same size; null for none
Stages<double> looks_reference(const MediumField& field, const TissueTable& table, const Probe& probe, double depth_mm,
                               const Settings& settings, std::span<const Pose> of_looks,
                               const Image<double>* frame_before = nullptr, const StoredSpeckle* stored = nullptr);

/// The results of the first step alone: I and R along given lines, and what makes the scatterers' echo.
struct ReferenceScan {
  Image<double> intensity, reflection;  ///< x line, y sample
  Image<double> echo_re, echo_im;       ///< empty with waves
  Image<double> amplitude, mirror;      ///< with waves: A and q of sim/model/waves.h
};
ReferenceScan traverse_reference(const MediumField& field, const TissueTable& table, const ScanLines& lines,
                                 const Settings& settings, const Pose& patient_from_probe, const SlicePlane& plane = {},
                                 const StoredSpeckle* stored = nullptr);

}  // namespace insonate
