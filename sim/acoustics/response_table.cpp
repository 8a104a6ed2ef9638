#include "sim/acoustics/response_table.h"

#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "sim/acoustics/beam_profile.h"
#include "sim/acoustics/echo_lines.h"

namespace insonate {
namespace {

constexpr double kStepsPerWidth = 10;       // across and in elevation, per full width
constexpr double kStepsPerWavelength = 20;  // along
constexpr double kPulseReach = 1.6;         // along, in pulse lengths (FWHM) to either side

}  // namespace

ResponseTable::ResponseTable(const Transducer& transducer, const Beamforming& beamforming, double depth_mm,
                             double density)
    : along_step_(transducer.wavelength_mm() / kStepsPerWavelength),
      phase_per_mm_(4 * glm::pi<double>() / transducer.wavelength_mm()) {
  const double pulse_mm = Pulse(transducer).impulse_fwhm_us() * kSpeedOfSound / 2 +
                          transducer.excitation_cycles * transducer.wavelength_mm() / 2;
  along_ = 2 * int(std::ceil(kPulseReach * pulse_mm / along_step_)) + 1;
  slices_.resize(std::size_t(std::lround(std::max(depth_mm - kNearest_mm, 0.0) / kDepthStep_mm)) + 1);
  tbb::parallel_for(std::size_t(0), slices_.size(), [&](std::size_t i) {
    slices_[i] = slice(transducer, beamforming, kNearest_mm + double(i) * kDepthStep_mm, density);
  });
}

ResponseTable::Slice ResponseTable::slice(const Transducer& transducer, const Beamforming& beamforming,
                                          double distance_mm, double density) const {
  const ScanLine line = line_at(transducer, 0);
  const ScanBeam beam(transducer, beamforming, line);
  const Pulse pulse(transducer);
  const BeamProfile profile = beam_profile(transducer, beamforming, line, distance_mm);
  Slice slice;
  slice.across = slice.elevation = int(kReach * kStepsPerWidth) + 1;
  slice.across_step = profile.lateral_mm / kStepsPerWidth;
  slice.elevation_step = profile.elevation_mm / kStepsPerWidth;
  slice.samples.resize(std::size_t(slice.across) * std::size_t(slice.elevation) * std::size_t(along_));
  const std::complex<double> i(0, 1);
  std::size_t next = 0;
  double power = 0;  // integral of |h|^2 over space
  for (int a = 0; a < slice.across; ++a)
    for (int e = 0; e < slice.elevation; ++e) {
      const EchoLine echo = point_echo(beam, pulse, {a * slice.across_step, distance_mm, e * slice.elevation_step});
      const double quarters = (a > 0 ? 2.0 : 1.0) * (e > 0 ? 2.0 : 1.0);
      for (int k = 0; k < along_; ++k) {
        const double behind_mm = (k - (along_ - 1) / 2.0) * along_step_;
        const double place = ((distance_mm + behind_mm) * 2 / echo.speed_mm_us - echo.first_us) / echo.step_us;
        std::complex<double> value = 0;
        if (place >= 0 && place < double(echo.samples.size() - 1)) {
          const std::size_t before = std::size_t(place);
          const double f = place - double(before);
          // Interpolated as an envelope: the carrier turns by a tenth of a turn and more from sample to sample.
          const auto envelope = [&](std::size_t n) {
            return echo.samples[n] * std::exp(-i * phase_per_mm_ * (echo.distance_mm(double(n)) - distance_mm));
          };
          value = (1 - f) * envelope(before) + f * envelope(before + 1);
        }
        power += quarters * std::norm(value);
        slice.samples[next++] = std::complex<float>(value);
      }
    }
  power *= slice.across_step * slice.elevation_step * along_step_ * density;
  const double mean = std::sqrt(glm::pi<double>() / 4 * power);  // of a Rayleigh envelope
  for (std::complex<float>& sample : slice.samples) sample = std::complex<float>(std::complex<double>(sample) / mean);
  return slice;
}

std::size_t ResponseTable::depth_index(double distance_mm) const {
  const double place = std::max((distance_mm - kNearest_mm) / kDepthStep_mm, 0.0);
  return std::min(std::size_t(std::lround(place)), slices_.size() - 1);
}

double ResponseTable::most_across_mm() const {
  double most = 0;
  for (std::size_t i = 0; i < slices_.size(); ++i) most = std::max(most, across_mm(i));
  return most;
}

double ResponseTable::most_elevation_mm() const {
  double most = 0;
  for (std::size_t i = 0; i < slices_.size(); ++i) most = std::max(most, elevation_mm(i));
  return most;
}

std::complex<double> ResponseTable::at(std::size_t depth, double across_mm, double elevation_mm,
                                       double behind_mm) const {
  const Slice& slice = slices_[depth];
  const double a = std::abs(across_mm) / slice.across_step, e = std::abs(elevation_mm) / slice.elevation_step,
               k = behind_mm / along_step_ + (along_ - 1) / 2.0;
  if (a >= slice.across - 1 || e >= slice.elevation - 1 || k < 0 || k >= along_ - 1) return 0;
  const int a0 = int(a), e0 = int(e), k0 = int(k);
  const float fa = float(a - a0), fe = float(e - e0), fk = float(k - k0);
  const auto row = [&](int da, int de) {
    const auto* at = &slice.samples[(std::size_t(a0 + da) * std::size_t(slice.elevation) + std::size_t(e0 + de)) *
                                        std::size_t(along_) +
                                    std::size_t(k0)];
    return at[0] * (1 - fk) + at[1] * fk;
  };
  const std::complex<float> value =
      (1 - fa) * ((1 - fe) * row(0, 0) + fe * row(0, 1)) + fa * ((1 - fe) * row(1, 0) + fe * row(1, 1));
  return std::complex<double>(value);
}

}  // namespace insonate
