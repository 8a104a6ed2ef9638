#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace insonate {

/// A small flat rectangle of a transducer's face. All of it moves as one piston.
struct Rectangle {
  glm::dvec3 centre{0.0};         ///< mm
  glm::dvec3 lateral{1, 0, 0};    ///< unit, along its width
  glm::dvec3 elevation{0, 0, 1};  ///< unit, along its height; perpendicular to `lateral`
  double width_mm = 0, height_mm = 0;
  double delay_us = 0;  ///< when it moves, in the mean, us
  double slope = 0;     ///< rise of the delay along the height, us/mm: the lens
  double weight = 1;    ///< apodization
};

/// The pistons that move together. Their face counts as a part of a rigid, plane baffle.
using Aperture = std::vector<Rectangle>;

/// The medium, and the sampling of responses.
struct Sampling {
  double speed_mm_us = 1.54;  ///< speed of sound
  double per_us = 100;        ///< sampling frequency, MHz

  double step_us() const { return 1 / per_us; }
};

/// A response in time. Sample k stands for the time (first + k) step_us(). It is the mean of the response weighted by a
/// hat of one step to either side, so its spectrum is that of the response times hat_spectrum(). A hat misses no jump
/// of the response. Up to a tenth of the sampling frequency, what folds back from higher frequencies is at most 1.3 %
/// of a jump's spectrum (sinc^2(0.9) / sinc^2(0.1)), and less of a smoother response's.
struct SampledResponse {
  std::int64_t first = 0;
  std::vector<double> samples;
};

/// Returns the factor that a SampledResponse puts on a spectrum: sinc^2(f step), 1 at f = 0.
double hat_spectrum(double frequency_mhz, const Sampling& sampling);

/// How a rectangle's response is computed.
enum class RectangleMethod {
  exact,      ///< at any distance; ignores Rectangle::slope
  far_field,  ///< as a trapezoid: for points some width^2 / wavelength away or more
};

/// Returns an aperture's spatial impulse response h at a point, mm/us: the velocity potential there, if the face moves
/// by an impulse of velocity (Tupholme, Mathematika 16, 1969; Stepanishen, J. Acoust. Soc. Am. 49, 1971):
///
///     h(p, t) = integral over the face of  weight delta(t - delay - r/c) / (2 pi r) dS,    r = distance to p
///
/// `exact` is the angle of the arc on which a sphere around p meets the rectangle, times c / (2 pi) (Jensen, J. Acoust.
/// Soc. Am. 105, 1999), integrated over the steps in closed form. `far_field` takes r as linear across the rectangle,
/// which makes h a trapezoid (Jensen and Svendsen, IEEE Trans. UFFC 39, 1992); larger faces are divided into
/// rectangles.
SampledResponse spatial_response(const Aperture& aperture, const glm::dvec3& point_mm, const Sampling& sampling,
                                 RectangleMethod method);

/// A far rectangle's response at one point: a trapezoid. Its sides and its top are the two times that a front takes
/// across the rectangle's width and height.
struct Trapezoid {
  double time_us = 0;                 ///< of its middle
  double wide_us = 0, narrow_us = 0;  ///< the longer and the shorter of the two times
  double area_mm = 0;                 ///< weight width height / (2 pi r)

  double begin_us() const { return time_us - (wide_us + narrow_us) / 2; }
  double end_us() const { return time_us + (wide_us + narrow_us) / 2; }
};
Trapezoid trapezoid_of(const Rectangle& rectangle, const glm::dvec3& point_mm, double speed_mm_us);

/// Returns the sum of trapezoids.
SampledResponse sum_of(const std::vector<Trapezoid>& trapezoids, const Sampling& sampling);

/// Returns the convolution of two responses: of both ways, mm^2/us.
SampledResponse convolved(const SampledResponse& a, const SampledResponse& b, const Sampling& sampling);

}  // namespace insonate
