#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <optional>
#include <vector>

namespace insonate {

/// How smoothly a hand moved, in two numbers that do not depend on how far or how fast it went: closer to 0 is
/// smoother. Definitions: Balasubramanian, Melendez-Calderon, Roby-Brami, Burdet, "On the analysis of movement
/// smoothness", J NeuroEng Rehabil 12:112 (2015).
///
/// Fed with positions at a fixed rate, so that the tracker's rate does not matter. A tracker's noise of a tenth of a
/// millimetre would rule third differences of 50 ms; the positions are smoothed first with the weights 1 4 6 4 1 (half
/// of the amplitude is left at 3.7 Hz of 20; a reach of the hand lies below 2 Hz). Stretches between losses of tracking
/// are put one behind the other.
class Smoothness {
public:
  explicit Smoothness(double rate_hz) : rate_hz_(rate_hz) {}

  /// @param follows  the position before was one step earlier
  void feed(const glm::dvec3& position_mm, bool follows);

  /// -ln(T^3 / v_peak^2 * integral of |d2v/dt2|^2), about -5.3 for one minimum-jerk reach. Empty without motion.
  std::optional<double> log_dimensionless_jerk() const;

  /// Length of the speed's normalised Fourier magnitude up to where it stays below kLeastShare, negative: about -1.4
  /// for one minimum-jerk reach.
  std::optional<double> spectral_arc_length() const;
  static constexpr double kLeastShare = 0.05;

private:
  double rate_hz_;
  std::array<glm::dvec3, 5> raw_{};
  std::array<glm::dvec3, 4> smooth_{};
  int raw_count_ = 0, smooth_count_ = 0;
  std::vector<double> speeds_mm_s_;  ///< of the smoothed positions, one a step
  double peak_mm_s_ = 0;
  double jerk_integral_ = 0;  ///< mm2/s5
};

}  // namespace insonate
