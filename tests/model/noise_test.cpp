#include "sim/model/noise.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "sim/probe/probe.h"

using namespace insonate;

TEST_CASE("electronic noise has the envelope of a complex normal signal, whatever the number of samples") {
  Settings settings;
  settings.electronic_noise = true;
  settings.reflection_length_mm = 0.5;
  ScanLines lines;
  lines.lines.resize(500);
  lines.r_max_mm = 200;
  lines.samples = 400;
  const Image<double> noise = electronic_noise(lines, settings);
  double mean = 0, square = 0, beside = 0;
  for (double e : noise.pixels) {
    mean += e / double(noise.pixels.size());
    square += e * e / double(noise.pixels.size());
  }
  for (int line = 1; line < noise.width; ++line)
    for (int k = 0; k < noise.height; ++k)
      beside += (noise.at(line, k) - mean) * (noise.at(line - 1, k) - mean) / double(noise.pixels.size());
  // 200,000 envelopes, independent where a sample is a reflection length: means are known to 0.0012, ratios to 0.005.
  CHECK(mean == Approx(1).margin(0.005));
  CHECK(mean / std::sqrt(square - mean * mean) == Approx(1.913).margin(0.02));
  CHECK(std::abs(beside) < 0.01 * (square - mean * mean));

  ScanLines finer = lines;
  finer.samples = 5 * lines.samples;  // whose sample 5 k + 2 lies where k did
  const Image<double> same = electronic_noise(finer, settings);
  for (int k = 0; k < noise.height; ++k) CHECK(same.at(7, 5 * k + 2) == Approx(noise.at(7, k)).epsilon(1e-9));
}

TEST_CASE("the noise of waves has power 1 at every pixel, on either side of a line, and is shifted by the pose alone") {
  const Probe& probe = *find_probe("curvilinear");
  const Settings settings = trainer_settings(3.5, 160);
  const ScanLines lines = scan_lines(probe, 160, settings.samples);
  const Image<std::complex<double>> noise = noise_wave(lines, settings);
  const ImageGeometry picture = image_geometry(probe, 160, 400, 300);
  double power = 0, corner = 0, n = 0, corners = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double here = std::norm(noise_of_pixel(noise, picture, lines, x, y));
      const bool inside = line_position(probe, 160, picture.plane_mm(x, y)).has_value();
      (inside ? power : corner) += here;
      ++(inside ? n : corners);
    }
  // Between samples of one line, which are not independent, a mean has a little less power.
  CHECK(power / n == Approx(1).epsilon(0.15));
  CHECK(corner / corners == Approx(1).epsilon(0.25));

  Pose here;
  here.translation = {12, -3, 55};
  Pose beside = here;
  beside.translation.x += 1e-4;
  CHECK(noise_shift(here) == noise_shift(here));
  CHECK(noise_shift(here) != noise_shift(beside));
  CHECK(noise_shift(here).x >= 0);
}

TEST_CASE("a volume's planes have the noise of all their lines, and neighbours have it in other places") {
  for (int lines = 30; lines <= 300; ++lines) {
    CAPTURE(lines);
    std::vector<int> at_line_0;  // whose noise, plane by plane
    for (int plane = 0; plane < lines; ++plane) at_line_0.push_back(noise_line(0, plane, lines));
    for (const std::size_t plane : {1, 2, 3, 4})
      CHECK(std::min(at_line_0[plane], lines - at_line_0[plane]) >= lines / 18);
    std::ranges::sort(at_line_0);
    CHECK(std::ranges::adjacent_find(at_line_0) == at_line_0.end());
    for (int line = 0; line < lines; ++line) {
      if (noise_line(line, 0, lines) != line) FAIL("the first plane's are a picture's");
      if (noise_line(line, 1, lines) != (line + noise_step(lines)) % lines) FAIL("all lines are shifted alike");
    }
  }
  CHECK(noise_line(0, 7, 1) == 0);
}
