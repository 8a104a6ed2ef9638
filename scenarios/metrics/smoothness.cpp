#include "scenarios/metrics/smoothness.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

namespace insonate {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Puts the newest value first.
template <std::size_t N>
void push(std::array<glm::dvec3, N>& history, const glm::dvec3& newest) {
  std::move_backward(history.begin(), history.end() - 1, history.end());
  history[0] = newest;
}

/// Radix-2 FFT in place; the size must be a power of two.
void fourier_transform(std::vector<std::complex<double>>& data) {
  const std::size_t size = data.size();
  for (std::size_t i = 1, j = 0; i < size; ++i) {
    std::size_t bit = size >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(data[i], data[j]);
  }
  for (std::size_t length = 2; length <= size; length <<= 1)
    for (std::size_t k = 0; k < length / 2; ++k) {
      const std::complex<double> turn = std::polar(1.0, -2 * kPi * double(k) / double(length));
      for (std::size_t i = k; i < size; i += length) {
        const std::complex<double> odd = data[i + length / 2] * turn;
        data[i + length / 2] = data[i] - odd;
        data[i] += odd;
      }
    }
}

}  // namespace

void Smoothness::feed(const glm::dvec3& position_mm, bool follows) {
  if (!follows) raw_count_ = smooth_count_ = 0;
  push(raw_, position_mm);
  if (++raw_count_ < int(raw_.size())) return;
  push(smooth_, (raw_[0] + 4.0 * raw_[1] + 6.0 * raw_[2] + 4.0 * raw_[3] + raw_[4]) / 16.0);
  if (++smooth_count_ < 2) return;
  speeds_mm_s_.push_back(glm::distance(smooth_[0], smooth_[1]) * rate_hz_);
  peak_mm_s_ = std::max(peak_mm_s_, speeds_mm_s_.back());
  if (smooth_count_ < int(smooth_.size())) return;
  const glm::dvec3 jerk =
      (smooth_[0] - 3.0 * smooth_[1] + 3.0 * smooth_[2] - smooth_[3]) * (rate_hz_ * rate_hz_ * rate_hz_);
  jerk_integral_ += glm::dot(jerk, jerk) / rate_hz_;
}

std::optional<double> Smoothness::log_dimensionless_jerk() const {
  if (!(peak_mm_s_ > 0) || !(jerk_integral_ > 0)) return std::nullopt;
  const double time_s = double(speeds_mm_s_.size()) / rate_hz_;
  return -std::log(time_s * time_s * time_s / (peak_mm_s_ * peak_mm_s_) * jerk_integral_);
}

std::optional<double> Smoothness::spectral_arc_length() const {
  if (!(peak_mm_s_ > 0)) return std::nullopt;
  // Zero padding to 4 times the next power of two interpolates the magnitude between the frequencies of the original
  // length.
  std::vector<std::complex<double>> spectrum(std::bit_ceil(speeds_mm_s_.size()) * 4);
  std::copy(speeds_mm_s_.begin(), speeds_mm_s_.end(), spectrum.begin());
  fourier_transform(spectrum);
  std::vector<double> magnitude(spectrum.size() / 2 + 1);
  for (std::size_t i = 0; i < magnitude.size(); ++i) magnitude[i] = std::abs(spectrum[i]);
  const double largest = *std::max_element(magnitude.begin(), magnitude.end());
  std::size_t last = magnitude.size() - 1;
  while (last > 0 && magnitude[last] < kMinShare * largest) --last;
  if (last == 0) return std::nullopt;
  double length = 0;
  for (std::size_t i = 1; i <= last; ++i)
    length += std::hypot(1.0 / double(last), (magnitude[i] - magnitude[i - 1]) / largest);
  return -length;
}

}  // namespace insonate
