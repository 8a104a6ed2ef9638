#include "sim/model/settings.h"

#include <algorithm>
#include <cmath>

namespace insonate {

double coupling_depth_mm(const Settings& settings) {
  constexpr double kRounding_mm = 1e-5;  // keeps the end of a sample's reflection length off the boundary
  return std::max(settings.gel_mm, settings.reflection_length_mm / 2 + kRounding_mm);
}

Settings with_usual_display(Settings settings) {
  settings.steering_angles = 3;
  settings.persistence = 0.3;
  settings.edge_enhancement = 0.5;
  settings.ring_down = kUsualRingDown;
  return settings;
}

Settings paper_settings(double depth_mm, int samples) {
  Settings settings;
  settings.samples = samples;
  settings.reflection_length_mm = depth_mm / samples;
  settings.absorption = false;
  settings.gel_mm = 0;
  settings.two_way = false;
  settings.focused_beam = false;
  settings.reverberation = false;
  settings.edge_shadow = false;
  settings.face_reflection = 0;
  settings.clutter = settings.electronic_noise = false;
  settings.mirror_image = settings.ring_down = 0;
  settings.steering_angles = 1;
  settings.persistence = settings.edge_enhancement = settings.speckle_reduction = 0;
  settings.reference_level = ReferenceLevel::frame_maximum;
  settings.dynamic_range_db = 55;  // of all measurements that docs/benchmarks has of this mode
  return settings;
}

Settings trainer_settings(double frequency_mhz, double depth_mm) {
  constexpr double kSoftTissueAbsorption = 0.5;                // dB/(cm MHz), what machines assume for an abdomen
  constexpr double kAxialResolutionCycles = 0.6 * 3.5 / 1.54;  // length of the pulse in cycles: 0.6 mm at 3.5 MHz
  constexpr int kFewestSamples = 16, kMaxSamples = 8192;
  Settings settings;
  settings.frequency_mhz = frequency_mhz;
  // Two samples per reflection length, which share their edges in the volume. The length is about the axial resolution.
  const double axial_resolution_mm = kAxialResolutionCycles * 1.54 / frequency_mhz;
  settings.samples = std::clamp(int(std::lround(2 * depth_mm / axial_resolution_mm)), kFewestSamples, kMaxSamples);
  settings.reflection_length_mm = 2 * depth_mm / settings.samples;
  settings.focused_beam = true;
  settings.focus_mm = std::clamp(depth_mm / 2, 5.0, 400.0);  // sonographers are taught to look there
  settings.slice_planes = 3;
  settings.reverberation = settings.edge_shadow = settings.clutter = settings.electronic_noise = true;
  settings.face_reflection = 0.02;
  settings.waves = true;
  settings.f_number = 3.5;      // between the transmit and the receive apertures that abdominal presets use, estimate
  settings.mirror_image = 0.1;  // by eye: an image is darker than what it shows, and dirty shadows are dark grey
  settings.specular_exponent = 6;  // by eye: side walls of vessels and cysts drop out, as they do on machines
  // Ten scatterers in a resolution cell, which is smallest at the focus (focused_beam_fwhm_mm()).
  const double lateral_mm = 0.886 * 1.54 / frequency_mhz * settings.f_number;
  settings.speckle_cell_mm =
      std::clamp(std::cbrt(settings.reflection_length_mm * lateral_mm * settings.slice_thickness_mm / 10), 0.05, 10.0);
  const double two_way_db = 2 * kSoftTissueAbsorption * frequency_mhz * depth_mm / 10;
  for (std::size_t i = 0; i < settings.tgc_db.size(); ++i)
    settings.tgc_db[i] = std::min(two_way_db * double(i) / double(settings.tgc_db.size() - 1), kMaxTimeGain_db);
  return settings;
}

}  // namespace insonate
