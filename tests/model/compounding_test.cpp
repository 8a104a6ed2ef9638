#include "sim/model/compounding.h"

#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <cstdint>

#include "sim/core/hash.h"
#include "sim/core/pose.h"
#include "sim/model/display_filter.h"
#include "sim/model/waves.h"

using namespace insonate;

TEST_CASE("looks are spread evenly about the straight one, and a phased probe and amplitudes have that alone") {
  Settings settings = trainer_settings(3.5, 100);
  settings.steering_angles = 5;
  settings.steering_deg = 10;
  const std::vector<double> angles = look_angles(*find_probe("curvilinear"), settings);
  REQUIRE(angles.size() == 5);
  for (int i = 0; i < 5; ++i) CHECK(angles[std::size_t(i)] == Approx(glm::radians(5.0 * (i - 2))).margin(1e-12));
  CHECK(angles[2] == 0);
  CHECK(look_angles(*find_probe("phased"), settings) == std::vector<double>{0});
  settings.waves = false;
  CHECK(look_angles(*find_probe("curvilinear"), settings) == std::vector<double>{0});
}

TEST_CASE("the phase of a look is that of its carrier against the straight one's, to a thousandth of a turn") {
  const Settings settings = trainer_settings(3.5, 100);
  const Pose pose{glm::dmat3(0, 0, -1, 1, 0, 0, 0, -1, 0), {10, -20, 5}};
  const double pitch = 0.7, steering = 0.14, lambda = 1.54 / 3.5;
  const glm::dmat4 probe_from_cells = glm::inverse(cells_from_patient(pitch) * pose.matrix());
  const std::array<std::uint32_t, 3> steps = phase_steps(probe_from_cells, settings, steering);
  const auto turns_at = [&](const glm::ivec3& cell) {
    std::uint32_t turn = 0;
    for (int axis = 0; axis < 3; ++axis) turn += steps[std::size_t(axis)] * std::uint32_t(cell[axis]) * 1024u;
    return turn * 0x1p-32;
  };
  const glm::ivec3 from(3, -7, 12);
  for (const glm::ivec3& to : {glm::ivec3(4, -7, 12), glm::ivec3(3, 5, 12), glm::ivec3(100, -80, 60)}) {
    const glm::dvec3 way = glm::dmat3(probe_from_cells) * glm::dvec3(to - from);
    const double expected = 2 / lambda * (std::sin(steering) * way.x + (std::cos(steering) - 1) * way.y);
    const double off = turns_at(to) - turns_at(from) - expected;
    CHECK(std::abs(off - std::round(off)) < 1e-3);
  }
  for (const std::uint32_t step : phase_steps(probe_from_cells, settings, 0)) CHECK(step == 0);
}

TEST_CASE("the display filter's window follows the wavelength, and its speckle the looks and the dynamic range") {
  Settings settings = trainer_settings(3.5, 100);
  settings.dynamic_range_db = 55.7;
  CHECK_FALSE(is_filtered(settings));
  CHECK(filter_sigma_mm(settings) == Approx(0.88));
  CHECK(filter_radius_px(settings, 0.4) == 5);
  CHECK(filter_radius_px(settings, 1e-6) == 639);
  // 5.57 dB is rounded.
  CHECK(speckle_variance(settings, 1) == Approx(0.01).epsilon(1e-3));
  settings.waves = false;
  CHECK(speckle_variance(settings, 1) == Approx(0.0025).epsilon(1e-3));
}

TEST_CASE("the display filter's variance of speckle is that of envelopes averaged over the looks") {
  Settings settings = trainer_settings(3.5, 100);
  settings.dynamic_range_db = 60;
  constexpr int kDraws = 100'000;  // the deviation of 100,000 values is known to 0.4 %
  for (const int looks : {1, 2, 3, 5, 7}) {
    double sum = 0, squares = 0;
    std::uint32_t counter = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      double envelope = 0;
      for (int look = 0; look < looks; ++look)
        envelope += std::sqrt(-std::log(1 - double(unit_float(hash(counter++, 7)))));
      const double db = 20 * std::log10(envelope / looks);
      sum += db, squares += db * db;
    }
    const double deviation_db = std::sqrt(squares / kDraws - sum / kDraws * sum / kDraws);
    CAPTURE(looks);
    // Envelopes' mean deviates up to 4 % more than the root of the mean of intensities: display_filter.h.
    CHECK(60 * std::sqrt(speckle_variance(settings, looks)) == Approx(deviation_db).epsilon(0.05));
  }
}
