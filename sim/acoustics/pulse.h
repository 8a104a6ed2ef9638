#pragma once

#include <complex>
#include <vector>

#include "sim/acoustics/transducer.h"

namespace insonate {

/// The pulse of a transducer, both ways: what comes back from a point in the focus, before the aperture's spatial
/// responses. It is the sine that drives the elements, filtered twice by the elements' response, with the derivatives
/// of radiation and scattering within it.
///
/// The elements' response is a sine under a Gaussian, each way. Both ways its spectrum is a Gaussian about the centre
/// frequency that falls to half at the two ends of the bandwidth; data sheets state the bandwidth in this form. The
/// Gaussian's mirror image at negative frequencies, which a sine subtracts, makes the response 0 at 0 MHz. It moves the
/// lower end by less than 1 % of the centre frequency up to a bandwidth of 80 %.
class Pulse {
public:
  explicit Pulse(const Transducer& transducer);

  /// Returns the spectrum of the analytic pulse, us; 0 at negative frequencies. The pulse's middle is at 0 us, and its
  /// envelope is 1 there.
  std::complex<double> spectrum(double frequency_mhz) const;

  double frequency_mhz() const { return frequency_mhz_; }

  /// Returns the time from the middle beyond which the real part is below 1e-6, us. The envelope of a pulse whose band
  /// begins near 0 MHz is up to 2e-3 there, and falls with the third power of the time.
  double half_length_us() const;

  /// Returns the full width at half maximum of the envelope of the elements' response both ways, us, which is the
  /// pulse's if an impulse drives them: 4 ln 2 / (pi bandwidth), with the bandwidth in MHz.
  double impulse_fwhm_us() const;

  /// Returns the one-way response of the elements, with an envelope of at most 1. The middle sample is at 0 us.
  std::vector<double> element_response(double per_us) const;
  /// Returns the sine that drives the elements, amplitude 1; a single 1 for an impulse.
  std::vector<double> excitation(double per_us) const;

private:
  std::complex<double> raw_spectrum(double frequency_mhz) const;

  double frequency_mhz_, sigma_mhz_, excitation_us_;
  double scale_ = 1;
};

}  // namespace insonate
