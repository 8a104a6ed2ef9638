#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sim/core/image.h"
#include "sim/reference/reference.h"

namespace insonate::test {

/// The distance between references with single-precision places and densities and the reference with exact ones.
/// Stages that the settings leave out are empty.
class Spread {
public:
  explicit Spread(const Stages<double>& of) {
    for (const auto part : kParts) all_.*part = Image<double>((of.*part).width, (of.*part).height);
    grey_ = Image<double>(of.grey.width, of.grey.height);
  }

  void include(const Stages<double>& expected, const Stages<double>& other) {
    for (const auto part : kParts) widen(all_.*part, expected.*part, other.*part);
    widen(grey_, expected.grey, other.grey);
  }

  /// Returns the tolerance of a stage at each place: `basic` of the reference's value, plus four times the spread,
  /// because it comes from few draws.
  template <typename Basic>
  Image<double> tolerated(const Stages<double>& expected, Image<double> Stages<double>::*part, Basic&& basic) const {
    Image<double> result = expected.*part;
    for (std::size_t i = 0; i < result.pixels.size(); ++i)
      result.pixels[i] = basic(result.pixels[i]) + 4 * (all_.*part).pixels[i];
    return result;
  }
  const Image<double>& grey() const { return grey_; }

private:
  using S = Stages<double>;
  static constexpr Image<double> S::*kParts[] = {&S::intensity, &S::reflection, &S::reflection_beam, &S::transmission,
                                                 &S::repeated,  &S::speckle,    &S::scattered,       &S::echo_re,
                                                 &S::echo_im,   &S::wave_re,    &S::wave_im,         &S::fused};

  template <typename Pixel>
  static void widen(Image<double>& spread, const Image<Pixel>& expected, const Image<Pixel>& other) {
    for (std::size_t i = 0; i < spread.pixels.size(); ++i)
      spread.pixels[i] = std::max(spread.pixels[i], std::abs(double(other.pixels[i]) - double(expected.pixels[i])));
  }

  Stages<double> all_;
  Image<double> grey_;
};

}  // namespace insonate::test
