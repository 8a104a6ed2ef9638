#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <optional>
#include <vector>

namespace insonate {

/// Measures the smoothness of a hand's motion in two numbers that do not depend on its distance or speed. A value
/// closer to 0 is smoother. Definitions: Balasubramanian, Melendez-Calderon, Roby-Brami, Burdet, "On the analysis of
/// movement smoothness", J NeuroEng Rehabil 12:112 (2015).
///
/// The positions come at a fixed rate, so that the tracker's rate does not matter. A tracker noise of 0.1 mm would
/// dominate third differences of 50 ms. The positions are therefore smoothed first with the weights 1 4 6 4 1, which
/// leave half of the amplitude at 3.7 Hz for a rate of 20 Hz. A reaching movement of the hand lies below 2 Hz.
/// Intervals between tracking losses are concatenated.
class Smoothness {
public:
  explicit Smoothness(double rate_hz) : rate_hz_(rate_hz) {}

  /// Adds one position.
  /// @param follows  true if the previous position was one step earlier
  void feed(const glm::dvec3& position_mm, bool follows);

  /// Returns -ln(T^3 / v_peak^2 * integral of |d2v/dt2|^2), about -5.3 for one minimum-jerk reach. Empty without
  /// motion.
  std::optional<double> log_dimensionless_jerk() const;

  /// Returns the negative arc length of the speed's normalised Fourier magnitude, up to the frequency above which it
  /// stays below kMinShare. It is about -1.4 for one minimum-jerk reach.
  std::optional<double> spectral_arc_length() const;
  static constexpr double kMinShare = 0.05;

private:
  double rate_hz_;
  std::array<glm::dvec3, 5> raw_{};
  std::array<glm::dvec3, 4> smooth_{};
  int raw_count_ = 0, smooth_count_ = 0;
  std::vector<double> speeds_mm_s_;  ///< of the smoothed positions, one per step
  double peak_mm_s_ = 0;
  double jerk_integral_ = 0;  ///< mm2/s5
};

}  // namespace insonate
