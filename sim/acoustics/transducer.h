#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sim/probe/probe.h"

namespace insonate {

/// The speed of sound that machines assume in soft tissue, mm/us (Szabo, Diagnostic Ultrasound Imaging, 1).
inline constexpr double kSpeedOfSound = 1.54;

/// An array of rectangular elements, as its manufacturer describes it. sim/core/pose.h describes its frame. Elements
/// lie side by side along x, on a flat face (linear, phased) or on an arc (curvilinear).
struct Transducer {
  std::string name;   ///< the trainer's probe that it stands for: "curvilinear"
  std::string title;  ///< the real array: "C5-2v"
  ProbeKind kind = ProbeKind::linear;
  int elements = 128;     ///< 1 to 1024
  double pitch_mm = 0.3;  ///< between the middles of neighbouring elements, along the arc if there is one; 0.02 to 5
  double kerf_mm = 0;     ///< gap between neighbouring elements, 0 to less than the pitch
  double radius_mm = 60;  ///< curvilinear: radius of the face, 5 to 200
  double height_mm = 5;   ///< of the elements, along the elevation, 0.1 to 50
  double elevation_focus_mm = 0;  ///< depth at which the lens focuses, 1 to 1000; 0 without a lens
  double frequency_mhz = 5;       ///< centre frequency, 0.5 to 30
  double bandwidth_percent = 70;  ///< of the centre frequency, at half the amplitude (-6 dB), both ways; 5 to 120
  double excitation_cycles = 1;   ///< length of the sine that drives the elements, 0 (an impulse) to 50

  double element_width_mm() const { return pitch_mm - kerf_mm; }
  double wavelength_mm() const { return kSpeedOfSound / frequency_mhz; }
  double face_mm() const { return elements * pitch_mm; }  ///< from edge to edge, along the face
  bool operator==(const Transducer&) const = default;
};

/// Reads a transducer's file, such as `assets/transducers/linear.toml`. Throws InputError.
Transducer read_transducer(const std::filesystem::path& toml_file);

/// Reads the bundled transducer that stands for a probe of the trainer (find_probe()). Throws InputError if there is
/// none of that name.
Transducer bundled_transducer(std::string_view probe);

/// An element's place. Its other side is along the elevation, z.
struct ElementPlace {
  glm::dvec3 centre{0.0};       ///< mm
  glm::dvec3 lateral{1, 0, 0};  ///< unit, along its width
};

/// Returns the places of all elements, from -x to +x.
std::vector<ElementPlace> element_places(const Transducer& transducer);

/// Returns the scan line that leaves the face at `position`: mm along the face from its middle (linear, curvilinear),
/// or degrees from the central beam, from the face's middle (phased).
ScanLine line_at(const Transducer& transducer, double position);

}  // namespace insonate
