#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace insonate {

/// The discrete Fourier transform of one length, in double precision, by KISS FFT. Several threads may use one.
class Transform {
public:
  /// @param length  1 or more; products of 2, 3 and 5 are fast
  explicit Transform(std::size_t length);
  ~Transform();
  Transform(const Transform&) = delete;
  Transform& operator=(const Transform&) = delete;

  std::size_t length() const;

  /// Returns sum over k of x_k exp(-2 pi i j k / length) for each j. `samples` may be shorter than the length; zeros
  /// follow.
  std::vector<std::complex<double>> forward(std::span<const double> samples) const;
  /// Returns 1 / length times the sum over j of X_j exp(2 pi i j k / length) for each k.
  std::vector<std::complex<double>> backward(const std::vector<std::complex<double>>& spectrum) const;

private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

/// Returns the smallest length of at least `least` that is a product of 2, 3 and 5.
std::size_t fast_length(std::size_t least);

}  // namespace insonate
