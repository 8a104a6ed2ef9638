#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "sim/shaders/shared/model_constants.h"

/// Echoes that add up as waves, with Settings::waves. Without it, the model is the paper's: amplitudes of a scatterer
/// lattice, and echoes of interfaces as intensities.
///
/// Point scatterers fill space, one at a random place in each cubic cell of `scatterer_pitch_mm()`. An interface is
/// a mirror, in part rough. All of them return the transmitted pulse, whose envelope is a Gaussian of full width at
/// half maximum l = reflection_length_mm. In complex baseband, sample k of a line holds what returns from its
/// surroundings. The slice's planes p (sim/model/beam.h) with weights g_p give the medium, the scatterers in the slice
/// its grain:
///
///     n   = c sum_s a_s v(z_s) h(x_s)                                        over the scatterers s
///     e   = kMirrorShare sum_p g_p q_p I_p + n (sum_p g_p (kRoughShare q_p I_p + b^(1/2) A_p T_p^(1/2))^2)^(1/2)
///     f   = e and its mirror images (mirror_image.h), convolved with the pulse along the line and with the beam across
///     the lines
///     U   = |f + d|^2 + V, with noise as in noise.h, d = ring_down_at(); 0 up to kMinEcho
///
/// a_s is the scatterer's complex amplitude, v the slice's window at its distance z_s from the imaging plane, h linear
/// weights of the two lines and the two samples nearest to it. c makes the mean of |f|^2 equal to b T A^2 in uniform
/// tissue. Without Settings::speckle n = i: the powers of interfaces and scatterers then add, as they do in the mean,
/// and where q is negative nothing cancels to a dark line. Where the slice holds several media, their powers add up.
/// Scatterers do not belong to planes: when the probe moves they would jump from one medium to the next. The phase that
/// the carrier gives an echo is part of a_s: a move of the probe turns the phases of all echoes in a resolution cell
/// alike, which no envelope shows.
///
/// q = +-(alpha |d . n|^m)^(1/2) alpha^2 / (alpha^2 + b^2/4) is the interface's amplitude (1, 3): negative where the
/// impedance falls, m = specular_exponent. The last factor keeps the noise and the texture of a CT from counting as
/// surfaces: what reflects less than scatterers do is not an interface. kMirrorShare and kRoughShare are estimates:
/// organs' surfaces are smooth mirrors only in part, so that their echo is patchy where they are met squarely, and
/// does not vanish where they are not. A = 10^(e/20) - 10^(kSilent_db/20) is the amplitude of scatterers of
/// echogenicity e dB. I, T, b, V are those of sim/model/stages.h.
///
/// So fully developed speckle has the statistics of a Rayleigh envelope at 20 log10: a standard deviation of 5.57 dB
/// (Wagner, Smith, Sandrik, Lopez, IEEE Transactions on Sonics and Ultrasonics 30, 1983). It moves with the tissue,
/// decorrelates over the beam's and the pulse's widths, and returns when the probe does. Lateral sums take amplitudes.
/// Their window is therefore that of the two-way amplitude, wider by 2^(1/2) than that of its square
/// (focused_beam_fwhm_mm()): 0.886 lambda N at the focus. The slice's window is the two-way amplitude in elevation.
namespace insonate {

/// The slice's window ends at this distance from the imaging plane, in thicknesses of the slice: v(z) = (1 - z^2/h^2)^2
/// has half its maximum at z = (1 - 2^(-1/2))^(1/2) h = h / 1.848. It is close to a Gaussian, and continuous at its
/// end.
inline constexpr double kSliceHalf = 0.924;

/// Returns the side of the scatterers' cells, mm: speckle_cell_mm, or more where the slice would hold over 2^22 cells,
/// or 64 between neighbouring lines and samples. More than these would change nothing but the time.
double scatterer_pitch_mm(const ScanLines& lines, const Settings& settings);

/// Returns the map from patient mm to cells: a rotation (ScattererLattice::kRotation_rad), then one unit per cell.
glm::dmat4 cells_from_patient(double pitch_mm);

/// A scatterer: where it lies in its cell, 0 to 1 along each axis, and its amplitude: 1, -1, i or -i.
struct Scatterer {
  glm::dvec3 place;
  std::complex<double> amplitude;
};

/// What a cell's coordinates are multiplied by for its hash. Cells with the same hash are 1731 cells apart or more:
/// found by trying 40 triples of random odd numbers.
inline constexpr std::array<std::uint32_t, 3> kCellKeys = {0xcd613e31u, 0xc386bbc5u, 0x1027c4d1u};

/// Returns the scatterer of a cell. The bits of h = hash(hash(seed) + x k_x + y k_y + z k_z), with kCellKeys and hash()
/// of sim/core/hash.h, decide: three times ten, lowest first, give the place, (m + 1/2) / 1024. Bit 30 chooses between
/// a real and an imaginary amplitude, bit 31 its sign.
///
/// All amplitudes are of one size, because then the fewest scatterers per resolution cell make a Rayleigh envelope.
Scatterer scatterer_of(const glm::ivec3& cell, std::uint32_t seed);

/// Returns the slice's window v, 0 to 1, at a distance from the imaging plane.
/// @param thickness_mm  slice_thickness_at_mm() there
double slice_window(double z_mm, double thickness_mm);

/// The largest half width of the pulse's window, in samples to either side. Longer pulses are shortened to fit.
inline constexpr int kMaxPulseRadius = 63;

/// Returns the pulse along a line: an odd number of weights, symmetric, sum 1, cut off at three standard deviations.
/// The linear weights h widen it by a variance of 1/6 sample^2, which its Gaussian is short of.
std::vector<double> pulse_weights(const ScanLines& lines, const Settings& settings);

/// Returns the amplitude d of the transducer's ring-down at a distance from the face. When a transducer begins to
/// receive, it still rings from its own pulse. Each picture therefore begins with a bright band, whatever lies there,
/// also in air. With white = fixed_level^(1/2) and the wavelength lambda,
///
///     d = ring_down white 10^(-r / (kRingDownWavelengths lambda))
///
/// 0 without waves. How long transducers ring is not published; kRingDownWavelengths is by eye, 20 dB in 8 periods, so
/// that the band is 2 mm wide at 3.5 MHz.
double ring_down_at(const Settings& settings, double r_mm);
inline constexpr double kRingDownWavelengths = 4;

/// Returns c at each sample.
std::vector<double> scatterer_scale(const ScanLines& lines, const Settings& settings);

/// Returns the largest root mean square that n / c has at any depth.
double scatterer_rms(const ScanLines& lines, const Settings& settings);

}  // namespace insonate
