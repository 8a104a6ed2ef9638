#pragma once

#include <array>
#include <cstdint>

#include "sim/tissue/coupling.h"

namespace insonate {

/// The shape of the receive beam across scan lines.
enum class BeamWindow { box, triangle, hann };

/// The reference level of the log compression.
enum class ReferenceLevel {
  frame_maximum,  ///< the brightest pixel of each frame is white, as in the paper
  fixed           ///< a fixed level is white, so that brightness stays constant while the probe moves
};

/// Maps echoes between black and white, as a share g from 0 to 1 of the dynamic range, to grey. Machines offer such
/// maps but their curves are not published: except for the paper's, these curves are this project's own.
enum class GreyMap {
  linear,    ///< g, as in the paper
  soft,      ///< g^0.75: lifts weak echoes
  contrast,  ///< g^1.5: suppresses weak echoes, so that fluid stands out
  s_curve    ///< g^2 (3 - 2 g): spreads the middle greys and compresses both ends
};

/// The largest time gain, dB. Sound that has lost as much counts as silent, and 10^30 with the gain on top still
/// fits single precision.
inline constexpr double kMaxTimeGain_db = 300;
/// What a machine shows from black to white, until somebody turns the knob.
inline constexpr double kUsualDynamicRange_db = 60;
/// A machine's Settings::ring_down: white at the face.
inline constexpr double kUsualRingDown = 1;

/// All settings of model S: how it turns a volume, a pose and a probe into a picture. Numbers in brackets are the
/// equations of Kutter, Shams, Navab 2009. A field added here also needs its line in settings_file.cpp.
struct Settings {
  // Traversal
  int samples = 512;                  ///< samples per line, 1 to 8192
  double reflection_length_mm = 0.6;  ///< l: the distance over which two media count as one interface, 0.01 to 20 (1)
  double frequency_mhz = 3.5;         ///< 0.5 to 30
  bool edge_shadow = false;  ///< subtracts the sound that refraction takes at grazing incidence, see refraction.h
  bool absorption = true;    ///< frequency-dependent absorption in (5); off in the paper's mode

  /// Thickness of the coupling gel between face and skin, 0 (none) to 100, see coupling_depth_mm().
  double gel_mm = kUsualGel_mm;

  /// Weights the voxels around a sample in single precision. The weights of a device's own filter may have as few as 8
  /// bits.
  bool exact_filter = false;

  bool skipping = true;  ///< skips work that cannot change a pixel by a grey level

  // Beam width (4)
  BeamWindow beam_window = BeamWindow::hann;
  int beam_lines = 7;  ///< n_a: lines under the window, odd, 1 (none) to 255
  bool focused_beam =
      false;  ///< the width follows from focus_mm and f_number instead of beam_lines, see focused_beam_fwhm_mm()
  double focus_mm = 80;  ///< depth of the transmit focus, 5 to 400
  double f_number = 6;   ///< focus over the width of the active aperture, 0.5 to 30

  int slice_planes = 1;           ///< planes that sample the beam in elevation, odd, 1 (infinitely thin) to 31
  double slice_thickness_mm = 3;  ///< full width at half maximum in elevation, 0.1 to 20
  double elevation_focus_mm = 0;  ///< depth at which that is so, see slice_thickness_at_mm(), 0 to 400; 0: every depth

  bool reverberation = false;  ///< reverberation between strong interfaces in the tissue, see reverberation.h
  double face_reflection = 0;  ///< share of the returning sound that the probe's face reflects, 0 (none) to 1

  /// Echoes add up as waves, see sim/model/waves.h; off in the paper's mode. The smoothing of (6) is then left out.
  bool waves = false;
  double specular_exponent = 1;  ///< with waves: m, how steeply an interface's echo falls with its tilt, 1 to 64
  double mirror_image = 0;       ///< with waves: share of what gas mirrors that returns, see mirror_image.h, 0 to 1

  // Spatial compounding with waves, of pictures: see compounding.h
  int steering_angles = 1;  ///< directions that the lines are steered to, odd, 1 (none) to 9
  double steering_deg = 8;  ///< the outermost of these, from the middle one to either side, 1 to 20

  // Speckle
  bool speckle = true;
  std::uint32_t speckle_seed = 1;
  double speckle_cell_mm = 0.65;  ///< side of a scatterer's cell, 0.05 to 10

  // Fusion (6)
  double reflection_sigma_mm = 0.45;  ///< s1: smoothing of the reflections in the image, 0 (none) to 1000
  double transmission_sigma_mm = 0;   ///< s2: smoothing of the transmission in the image, 0 (none) to 1000
  double blend = 4e-5;                ///< b: weight of the scattered against the reflected echo, 0 to 1000
  bool two_way = true;  ///< T = (I/I0)^2: the scattered echo is attenuated on its way back too; off in the paper

  // Receiver
  bool clutter = false;           ///< adds the echo from the beam's side lobes, see clutter_share()
  double clutter_db = -30;        ///< clutter relative to the scatterers' mean echo from its depth, -100 to 0
  bool electronic_noise = false;  ///< added to the echo before any gain, so that it shows where time gain is high
  double noise_db = -103;         ///< mean of the noise relative to fixed_level, -200 to 0
  double ring_down = 0;  ///< with waves: the transducer's own echo at its face, in amplitudes of white, 0 (none) to 10,
                         ///< see ring_down_at()

  // Display (7): like the controls of the same names on machines (Szabo, Diagnostic Ultrasound Imaging, 10)
  double gain_db = 0;              ///< -60 to 60
  std::array<double, 8> tgc_db{};  ///< time gain at 8 depths from face to full depth, linear between; -300 to 300
  double dynamic_range_db = kUsualDynamicRange_db;  ///< beta, 1 to 200
  ReferenceLevel reference_level = ReferenceLevel::fixed;
  double fixed_level = 0.014;  ///< the U that is white before gain, 1e-12 to 1e6
  GreyMap grey_map = GreyMap::linear;
  double persistence = 0;        ///< share of the frame before in a picture in motion, 0 (none) to 0.95
  double edge_enhancement = 0;   ///< of pictures, 0 (none) to 4, see display_filter.h
  double speckle_reduction = 0;  ///< of pictures, 0 (none) to 1, see display_filter.h

  int image_width = 640;   ///< 1 to 8192
  int image_height = 480;  ///< 1 to 8192

  bool operator==(const Settings&) const = default;
};

/// Returns the distance from the face, mm, within which air counts as water: the gel's thickness, or half the
/// reflection length plus 1e-5 mm if that is more. The face's lens is matched to tissue (Szabo, Diagnostic Ultrasound
/// Imaging, 5), so sound leaves it as it leaves water, and air against it reflects nearly all. An interface is spread
/// over half the reflection length to either side. Lines begin at the face. So the interface to air must lie half its
/// width behind it, or lines would meet only a part of it.
double coupling_depth_mm(const Settings& settings);

/// Returns the settings with what a machine and its abdominal preset add to a picture: ring-down, three steering
/// angles, mild persistence and edge enhancement (Szabo, Diagnostic Ultrasound Imaging, 10; the amounts are by eye).
Settings with_usual_display(Settings settings);

/// Returns the paper's settings: no absorption, reflection length = sample distance, one-way transmission, frame's
/// maximum, no noise, no clutter, a beam equally wide at every depth.
Settings paper_settings(double depth_mm, int samples);

/// Returns the trainer's initial settings: every effect on, TGC set to the mean absorption of soft tissue up to
/// `depth_mm`.
Settings trainer_settings(double frequency_mhz, double depth_mm);

}  // namespace insonate
