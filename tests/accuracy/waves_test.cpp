// Tests speckle that adds up as waves: its statistics, its grain, and how it changes when the probe moves. The expected
// figures follow from the widths of pulse, beam and slice alone (Wagner, Smith, Sandrik, Lopez, IEEE Trans. Sonics
// Ultrason. 30 (1983) 156): with amplitudes h of a standard deviation s, the correlation of intensities at a distance d
// is exp(-d^2 / (2 s^2)) for a Gaussian h.

#include "sim/model/waves.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "sim/model/beam.h"
#include "sim/reference/reference.h"
#include "sim/reference/wave_reference.h"
#include "tests/accuracy/media.h"

using namespace insonate;
using namespace insonate::test;

namespace {

using Wave = Image<std::complex<double>>;

struct Block {
  Probe probe;
  double depth_mm = 60;
  Settings settings;

  explicit Block(const char* name) : probe(*find_probe(name)) {
    depth_mm = probe.depth_mm;
    settings = trainer_settings(probe.frequency_mhz, depth_mm);
  }
  ScanLines lines() const { return scan_lines(probe, depth_mm, settings.samples); }
  /// f in a block that scatters as liver does, without absorption or interfaces; b T = 1.
  Wave wave(const Pose& pose = {}) const {
    return wave_reference(scatterers_reference(lines(), settings, pose), lines(), settings);
  }
};

struct Region {
  int first_line, last_line, first_sample, last_sample;
};

/// Away from the array's and the lines' ends, where the aperture and the pulse are whole.
Region inner(const Wave& wave) {
  return {wave.width / 8, wave.width - wave.width / 8, 10, wave.height - 10};
}

double mean_power(const Wave& wave, const Region& in) {
  double sum = 0;
  for (int k = in.first_sample; k < in.last_sample; ++k)
    for (int line = in.first_line; line < in.last_line; ++line) sum += std::norm(wave.at(line, k));
  return sum / double((in.last_line - in.first_line) * (in.last_sample - in.first_sample));
}

/// Returns the correlation coefficient of the intensities of two waves, the second taken `lines` and `samples` on.
double correlation(const Wave& a, const Wave& b, const Region& in, int lines = 0, int samples = 0) {
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0, n = 0;
  for (int k = in.first_sample; k < in.last_sample - samples; ++k)
    for (int line = in.first_line; line < in.last_line - lines; ++line, ++n) {
      const double x = std::norm(a.at(line, k)), y = std::norm(b.at(line + lines, k + samples));
      mean_a += x, mean_b += y, aa += x * x, bb += y * y, ab += x * y;
    }
  mean_a /= n, mean_b /= n;
  return (ab / n - mean_a * mean_b) / std::sqrt((aa / n - mean_a * mean_a) * (bb / n - mean_b * mean_b));
}

Pose moved(double lateral_mm, double depth_mm, double elevation_mm) {
  Pose pose;
  pose.translation = {lateral_mm, depth_mm, elevation_mm};
  return pose;
}

struct Statistics {
  double signal_to_noise, off_rayleigh;
  std::size_t count;
};

/// Of envelopes that lie a resolution cell or more from each other.
Statistics statistics(const Wave& wave, const Region& in, int line_step, int sample_step) {
  std::vector<double> envelope;
  for (int k = in.first_sample; k < in.last_sample; k += sample_step)
    for (int line = in.first_line; line < in.last_line; line += line_step)
      envelope.push_back(std::abs(wave.at(line, k)));
  std::ranges::sort(envelope);
  const double n = double(envelope.size());
  double sum = 0, squares = 0;
  for (const double a : envelope) sum += a, squares += a * a;
  Statistics found{sum / n / std::sqrt(squares / n - sum / n * sum / n), 0, envelope.size()};
  for (std::size_t i = 0; i < envelope.size(); ++i) {
    const double rayleigh = -std::expm1(-envelope[i] * envelope[i] * n / squares);
    found.off_rayleigh = std::max({found.off_rayleigh, rayleigh - double(i) / n, double(i + 1) / n - rayleigh});
  }
  return found;
}

double sigma_of(double fwhm) {
  return fwhm / std::sqrt(8 * std::log(2.0));
}

/// Returns the distance at which a correlation of intensities falls to a half, twice, by linear interpolation.
double width_of(const Wave& wave, const Region& in, bool along, double step_mm) {
  double before = 1;
  for (int step = 1; step < 60; ++step) {
    const double now = along ? correlation(wave, wave, in, 0, step) : correlation(wave, wave, in, step, 0);
    if (now < 0.5) return 2 * step_mm * (step - 1 + (before - 0.5) / (before - now));
    before = now;
  }
  return 0;
}

}  // namespace

TEST_CASE("waves of a uniform block are a Rayleigh envelope of power 1 at every depth, for every probe") {
  for (const char* name : {"curvilinear", "linear", "phased"}) {
    INFO(name);
    Block block(name);
    std::vector<double> envelope_to_noise, share_off;
    double power = 0, near = 0, far = 0;
    constexpr int kSeeds = 6;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      block.settings.speckle_seed = std::uint32_t(seed);
      const Wave wave = block.wave();
      const Region in = inner(wave);
      const Statistics found = statistics(wave, in, 12, 5);
      envelope_to_noise.push_back(statistics(wave, in, 2, 1).signal_to_noise);
      share_off.push_back(found.off_rayleigh * std::sqrt(double(found.count)));
      power += mean_power(wave, in) / kSeeds;
      const int part = (in.last_sample - in.first_sample) / 4;
      near += mean_power(wave, {in.first_line, in.last_line, in.first_sample, in.first_sample + part}) / kSeeds;
      far += mean_power(wave, {in.first_line, in.last_line, in.last_sample - part, in.last_sample}) / kSeeds;
    }
    double mean = 0;
    for (const double snr : envelope_to_noise) mean += snr / kSeeds;
    CHECK(mean == Approx(std::sqrt(M_PI / (4 - M_PI))).margin(0.03));
    // Kolmogorov-Smirnov at 5 % for the median of six draws: half of them stay well below its limit.
    std::ranges::sort(share_off);
    CHECK(share_off[kSeeds / 2] < 1.36);
    CHECK(power == Approx(1).epsilon(0.03));  // some 1500 resolution cells in each of six draws
    CHECK(10 * std::log10(far / near) == Approx(0).margin(0.5));
  }
}

TEST_CASE("sparse scatterers are not taken for fully developed speckle") {
  Block block("linear");
  block.settings.speckle_cell_mm = 3;  // one scatterer in thirty resolution cells
  const Wave wave = block.wave();
  const Statistics found = statistics(wave, inner(wave), 12, 5);
  CHECK(found.off_rayleigh > 3 * 1.36 / std::sqrt(double(found.count)));
  CHECK(found.signal_to_noise < 1.5);
}

TEST_CASE("the display's speckle has the standard deviation of a Rayleigh envelope in decibels") {
  Block block("curvilinear");
  block.settings.dynamic_range_db = 60;
  double sum = 0, squares = 0, n = 0;
  const Wave wave = block.wave();
  const Region in = inner(wave);
  for (int k = in.first_sample; k < in.last_sample; ++k)
    for (int line = in.first_line; line < in.last_line; ++line) {
      const double db = 10 * std::log10(std::norm(wave.at(line, k)));
      sum += db, squares += db * db, ++n;
    }
  CHECK(std::sqrt(squares / n - sum / n * sum / n) == Approx(5.57).epsilon(0.05));
}

TEST_CASE("the grain is as long as the pulse and as wide as the beam") {
  for (const char* name : {"curvilinear", "linear"}) {
    INFO(name);
    const Block block(name);
    const ScanLines lines = block.lines();
    const Wave wave = block.wave();
    const Region in = inner(wave);
    // Intensities of a Gaussian amplitude of full width w correlate to a half at w/2.
    CHECK(width_of(wave, in, true, lines.dr_mm()) == Approx(block.settings.reflection_length_mm).epsilon(0.1));
    for (const double depth_mm : {0.3 * block.depth_mm, 0.5 * block.depth_mm, 0.8 * block.depth_mm}) {
      const int k = int(depth_mm / lines.dr_mm()), around = wave.height / 12;
      const double spacing =
          lines.fan.step * (lines.fan.face == LineFan::Face::parallel ? 1 : lines.fan.apex_mm + depth_mm);
      const double fwhm = std::sqrt(2.0) * focused_beam_fwhm_mm(block.settings, lines.aperture_mm, depth_mm);
      INFO("at " << depth_mm << " mm");
      CHECK(width_of(wave, {in.first_line, in.last_line, k - around, k + around}, false, spacing) ==
            Approx(fwhm).epsilon(0.15));
    }
  }
}

TEST_CASE("the grain decorrelates as the probe moves by as much as pulse, beam and slice are wide") {
  Block block("linear");
  block.settings.f_number = 3.5;
  const Wave still = block.wave();
  const Region in = inner(still);
  const auto after = [&](double x, double y, double z) { return correlation(still, block.wave(moved(x, y, z)), in); };

  for (const double d : {0.15, 0.3, 0.45}) {
    double expected = 0;  // the beam's width changes with depth
    for (int k = in.first_sample; k < in.last_sample; ++k) {
      const double r = (k + 0.5) * block.lines().dr_mm();
      const double lateral =
          sigma_of(std::sqrt(2.0) * focused_beam_fwhm_mm(block.settings, block.lines().aperture_mm, r));
      expected += std::exp(-d * d / (2 * lateral * lateral)) / (in.last_sample - in.first_sample);
    }
    INFO(d << " mm to the side");
    CHECK(after(d, 0, 0) == Approx(expected).epsilon(0.15));
  }
  const double axial = sigma_of(block.settings.reflection_length_mm);
  for (const double d : {0.5 * axial, axial, 1.5 * axial}) {
    INFO(d << " mm along the beam");
    CHECK(after(0, d, 0) == Approx(std::exp(-d * d / (2 * axial * axial))).epsilon(0.15));
  }
  // The slice's window is not Gaussian, so its correlation is summed.
  const double thickness = block.settings.slice_thickness_mm;
  double before = 1;
  for (const double d : {0.2, 0.4, 1.0, 1.7, 3.0}) {
    double overlap = 0, whole = 0;
    for (double z = -4; z < 4; z += 0.001) {
      overlap += slice_window(z, thickness) * slice_window(z + d, thickness);
      whole += slice_window(z, thickness) * slice_window(z, thickness);
    }
    INFO(d << " mm in elevation");
    const double found = after(0, 0, d);
    CHECK(found == Approx(overlap / whole * overlap / whole).epsilon(0.15).margin(0.03));
    CHECK(found < before);  // falls once, and does not come back
    before = found;
  }
}

TEST_CASE("the grain has no period and nothing beside its peak") {
  Block block("linear");
  const Wave here = block.wave();
  const Region in = inner(here);
  for (const double away_mm : {5.0, 41.6, 83.2, 166.4, 399.0}) {  // 83.2: the period of the paper's lattice at 0.65 mm
    INFO(away_mm);
    CHECK(std::abs(correlation(here, block.wave(moved(away_mm, 0, 0)), in)) < 0.05);
    CHECK(std::abs(correlation(here, block.wave(moved(0, away_mm, 0)), in)) < 0.05);
    CHECK(std::abs(correlation(here, block.wave(moved(0, 0, away_mm)), in)) < 0.05);
  }
  for (int step = 12; step < 30; ++step) CHECK(std::abs(correlation(here, here, in, 0, step)) < 0.05);
}

TEST_CASE("an interface is a pulse: it has its width, once, with its strength") {
  Block block("linear");
  Settings& settings = block.settings;
  settings.speckle = settings.absorption = settings.reverberation = settings.edge_shadow = false;
  settings.clutter = settings.electronic_noise = false;
  settings.face_reflection = 0;
  settings.blend = 1e-12;  // silent scatterers
  const double at_mm = 25.03;
  const auto field = [&](const glm::dvec3& p) { return Medium{p.y < at_mm ? 20.0 : 60.0, -60}; };
  const Stages<double> stages = simulate_reference(field, plain_table(), block.probe, block.depth_mm, settings, {});
  const int line = stages.wave_re.width / 2;
  const double dr = block.lines().dr_mm();
  double peak = 0, sum = 0, where = 0;
  for (int k = 0; k < stages.wave_re.height; ++k) {
    const double amplitude = std::hypot(stages.wave_re.at(line, k), stages.wave_im.at(line, k));
    peak = std::max(peak, amplitude);
    sum += amplitude;
    where += amplitude * (k + 0.5) * dr;
  }
  CHECK(where / sum == Approx(at_mm).margin(dr / 2));
  double above_half = 0;
  for (int k = 0; k < stages.wave_re.height; ++k)
    above_half += std::hypot(stages.wave_re.at(line, k), stages.wave_im.at(line, k)) > peak / 2;
  // The pulse, behind the box of one reflection length that (1) takes for an interface: 1.26 of it, known to a sample.
  CHECK(above_half * dr == Approx(1.26 * settings.reflection_length_mm).margin(dr));
}
