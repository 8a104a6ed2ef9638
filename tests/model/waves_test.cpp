#include "sim/model/waves.h"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "sim/model/beam.h"

using namespace insonate;

namespace {

ScanLines linear_lines(int samples = 200) {
  Probe probe = *find_probe("linear");
  probe.lines = 64;
  return scan_lines(probe, 50, samples);
}

}  // namespace

TEST_CASE("the scatterer of a cell is the same everywhere") {
  // Computed by the formula of waves.h in another language.
  const Scatterer drawn = scatterer_of({-3, 17, 250}, 1);
  CHECK(drawn.place == (glm::dvec3(716, 724, 211) + 0.5) / 1024.0);
  CHECK(drawn.amplitude == std::complex<double>(0, -1));
}

TEST_CASE("scatterers have a mean of 0, evenly spread places, and no relation to their neighbours") {
  constexpr int kSide = 60;
  std::complex<double> sum = 0, unrotated = 0, far = 0;
  std::array<std::complex<double>, 27> beside{};
  glm::dvec3 place(0);
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y)
      for (int z = 0; z < kSide; ++z) {
        const Scatterer here = scatterer_of({x, y, z}, 5);
        sum += here.amplitude;
        unrotated += here.amplitude * here.amplitude;
        place += here.place;
        for (int i = 0; i < 27; ++i)
          beside[std::size_t(i)] +=
              here.amplitude * std::conj(scatterer_of({x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1}, 5).amplitude);
        // The period of the paper's lattice.
        far += here.amplitude * std::conj(scatterer_of({x + 128, y, z}, 5).amplitude);
      }
  const double n = std::pow(kSide, 3), error = 4 / std::sqrt(n);  // four standard errors
  CHECK(std::abs(sum / n) < error);
  CHECK(std::abs(unrotated / n) < error);  // as often real as imaginary
  CHECK(std::abs(far / n) < error);
  for (int i = 0; i < 27; ++i) {
    CAPTURE(i);
    if (i == 13) CHECK(beside[13].real() == n);  // each is of size 1
    if (i != 13) CHECK(std::abs(beside[std::size_t(i)] / n) < error);
  }
  for (int axis = 0; axis < 3; ++axis) CHECK(place[axis] / n == Approx(0.5).margin(error / std::sqrt(12.0)));
}

TEST_CASE("the slice's window has its width at half of its maximum and ends") {
  CHECK(slice_window(0, 3) == 1);
  CHECK(slice_window(1.5, 3) == Approx(0.5).margin(0.001));
  CHECK(slice_window(-1.5, 3) == slice_window(1.5, 3));
  CHECK(slice_window(3 * kSliceHalf, 3) == 0);
  CHECK(slice_window(5, 3) == 0);
}

TEST_CASE("the pulse has the reflection length as its width, behind the linear weights") {
  Settings settings = trainer_settings(7.5, 50);
  const ScanLines lines = linear_lines(settings.samples);
  const std::vector<double> pulse = pulse_weights(lines, settings);
  REQUIRE(pulse.size() % 2 == 1);
  double sum = 0, variance = 0;
  const int radius = int(pulse.size() / 2);
  for (int m = -radius; m <= radius; ++m) {
    sum += pulse[std::size_t(m + radius)];
    variance += m * m * pulse[std::size_t(m + radius)];
  }
  CHECK(sum == Approx(1));
  const double fwhm_mm = lines.dr_mm() * std::sqrt((variance + 1.0 / 6) * 8 * std::log(2.0));
  CHECK(fwhm_mm == Approx(settings.reflection_length_mm).epsilon(0.02));  // cut off at three standard deviations

  settings.reflection_length_mm = 0.01;  // shorter than a sample: no pulse
  CHECK(pulse_weights(lines, settings) == std::vector<double>{1});
  settings.reflection_length_mm = 20;
  CHECK(pulse_weights(linear_lines(8192), settings).size() == 2 * kMaxPulseRadius + 1);
}

TEST_CASE("the scatterers' cells grow where the slice would hold too many or a sample would see thousands") {
  Settings settings = trainer_settings(7.5, 50);
  const ScanLines lines = linear_lines(settings.samples);
  CHECK(scatterer_pitch_mm(lines, settings) == settings.speckle_cell_mm);
  settings.speckle_cell_mm = 0.05;
  const ScanLines fine = scan_lines(*find_probe("linear"), 50, 1000);
  const double volume = 40.0 * 50 * 2 * kSliceHalf * settings.slice_thickness_mm;
  CHECK(volume / std::pow(scatterer_pitch_mm(fine, settings), 3) == Approx(1 << 22).epsilon(0.01));
  const double coarse = scatterer_pitch_mm(linear_lines(1), settings);
  CHECK(coarse > 0.5);
}

TEST_CASE("a transducer rings as loud as white at its face, and 20 dB less every four wavelengths") {
  Settings settings = trainer_settings(3.5, 160);
  CHECK(ring_down_at(settings, 0) == 0);
  settings.ring_down = 1;
  CHECK(std::pow(ring_down_at(settings, 0), 2) == Approx(settings.fixed_level));
  CHECK(ring_down_at(settings, 4 * 1.54 / 3.5) == Approx(0.1 * ring_down_at(settings, 0)));
  CHECK(ring_down_at(settings, 8 * 1.54 / 3.5) == Approx(0.01 * ring_down_at(settings, 0)));
  settings.waves = false;
  CHECK(ring_down_at(settings, 0) == 0);
}
