#pragma once

#include <glm/vec3.hpp>

#include <vector>

#include "sim/acoustics/spatial_response.h"
#include "sim/acoustics/transducer.h"
#include "sim/probe/probe.h"

namespace insonate {

/// The weights of the elements across an aperture.
enum class Apodization { uniform, hann };

/// How a machine forms its scan lines, and through which medium.
struct Beamforming {
  double transmit_focus_mm = 80;  ///< along the line, 1 to 1000
  double transmit_f_number = 6;   ///< focus over the width of the transmit aperture, 0.5 to 30
  double receive_f_number = 6;    ///< depth over the width of the receive aperture, 0.5 to 30
  bool dynamic_receive = true;    ///< focuses on the depth that each echo comes from; else as transmitted
  Apodization transmit_apodization = Apodization::uniform;
  Apodization receive_apodization = Apodization::uniform;
  double attenuation_db_cm_mhz = 0;  ///< of the medium, one way, proportional to the frequency; 0 to 10
  Sampling sampling;
  /// Depth from which the responses of an aperture without a lens are accurate to a hundredth of their integral, and
  /// from twice as deep to 0.3 %, mm. Elements are divided into rectangles so small that a front that meets their
  /// middle there is a 16th of a wavelength from their edges.
  double nearest_mm = 10;
};

/// One scan line of a transducer: the elements that transmit and receive it, with their delays and weights. The delays
/// let everything arrive from a point on the line, at the distance r from its start, at the time 2 r / c after the
/// transmission. The receive aperture grows with the depth until it is the whole array. The lens of the elevation
/// delays the parts of an element.
class ScanBeam {
public:
  ScanBeam(const Transducer& transducer, const Beamforming& beamforming, const ScanLine& line);

  const ScanLine& line() const { return line_; }
  const Beamforming& beamforming() const { return beamforming_; }

  /// Returns the spatial response of the transmit aperture, mm/us.
  SampledResponse transmitted(const glm::dvec3& point_mm) const;
  /// Returns the spatial response of the receive aperture, as it is focused when the point's echo arrives, mm/us.
  SampledResponse received(const glm::dvec3& point_mm) const;
  /// Returns their convolution, mm^2/us.
  SampledResponse both_ways(const glm::dvec3& point_mm) const;

  /// Returns the rectangles that transmit, with delays and weights.
  Aperture transmit_aperture() const;
  /// Returns the rectangles that receive an echo from a distance along the line.
  Aperture receive_aperture(double distance_mm) const;

private:
  /// Delays and weights of the elements `first` to `first + delays_us.size() - 1`.
  struct Steering {
    std::size_t first = 0;
    std::vector<double> delays_us, weights;
    std::size_t end() const { return first + delays_us.size(); }
  };
  Steering steered(double focus_mm, double width_mm, Apodization apodization) const;
  Steering receive_steering(double distance_mm) const;
  Aperture aperture_of(const Steering& steering) const;
  void add(std::vector<Trapezoid>& to, const Trapezoid& base, const Steering& steering, std::size_t element) const;

  ScanLine line_;
  Beamforming beamforming_;
  std::vector<glm::dvec3> centres_;
  std::size_t per_element_ = 1;
  Aperture rectangles_;  // per_element_ per element, with the delays of the lens
  Steering transmit_;
};

/// Returns the side of the rectangles into which elements are divided, mm: sqrt(wavelength * nearest_mm / 2).
double largest_rectangle_mm(const Transducer& transducer, double nearest_mm);

}  // namespace insonate
