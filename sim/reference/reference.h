#pragma once

#include <cstdint>
#include <functional>

#include "sim/core/pose.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/beam.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/model/tissue.h"
#include "sim/probe/probe.h"

namespace insonate {

/// What lies at a point, however it is stored: the reference also takes fields given by a formula, against which its
/// own accuracy can be measured.
struct Medium {
  double hu = -1000;
  double echogenicity_db = -60;
};
using MediumField = std::function<Medium(const glm::dvec3& patient_mm)>;

/// Within the gel layer all air is gel. Of what is less dense than kCouplingTissueHu, as the skin's outermost voxels
/// are, a share is, evenly more down to kCouplingAirHu: were there a density at which tissue turned into gel at once,
/// echoes of the skin would come and go while the probe moves.
inline constexpr double kCouplingTissueHu = -150, kCouplingAirHu = kMostAirHu;

/// What the sound meets where the field has `medium`, at a distance from the face along the line: nearer than
/// coupled_mm() (sim/model/settings.h) water without any echo takes the place of air.
Medium with_gel(const Medium& medium, double r_mm, double coupled_mm);

/// The trilinear field of a volume, with air outside.
MediumField trilinear_field(const AcousticVolume& volume);

/// Gain and time gain at a share of the imaging depth, 0 to 1, as a factor on U.
double time_gain(const Settings& settings, double depth_share);

/// What is left of an echo where those below kLeastEcho are none.
double heard(double echo);

/// Log compression (7) and the grey map: 255 at `level`, 0 where `echo` is the dynamic range below it, or nothing.
std::uint8_t grey_level(const Settings& settings, double echo, double level);

/// Model S in double precision, as MODEL.md's formulas read, in plain loops: the measure of everything faster. What it
/// takes from sim/model and sim/probe the shaders are handed as well, and tests of its own hold it: the tissue table,
/// the lines' and pixels' geometry, the scatterers' lattice, the beam's and the slice's weights, the levels of
/// noise and clutter, and constants. All that is computed along lines and at pixels is written here once more. Checks
/// none of what it is given, which is to be as a simulator takes it (sim/imaging/simulator.h).
Stages<double> simulate_reference(const MediumField& field, const TissueTable& table, const Probe& probe,
                                  double depth_mm, const Settings& settings, const Pose& patient_from_probe);

/// The first step alone: I and R along given lines, and the scatterers' echo.
struct ReferenceScan {
  Image<double> intensity, reflection;  ///< x line, y sample
  Image<double> echo_re, echo_im;
};
ReferenceScan traverse_reference(const MediumField& field, const TissueTable& table, const ScanLines& lines,
                                 const Settings& settings, const Pose& patient_from_probe,
                                 const SlicePlane& plane = {0, 1});

}  // namespace insonate
