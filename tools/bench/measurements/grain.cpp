#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "sim/acoustics/speckle_statistics.h"
#include "sim/files/files.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/model/beam.h"
#include "sim/model/compounding.h"
#include "sim/model/display_filter.h"
#include "sim/model/waves.h"
#include "tools/bench/commands.h"

namespace insonate::bench {
namespace {

constexpr double kDynamicRange_db = 60;

/// A block that scatters as liver does and absorbs nothing.
AcousticVolume block() {
  AcousticVolume volume;
  volume.grid.size = {2, 2, 2};
  volume.grid.spacing = glm::dvec3(1000);
  volume.grid.origin = {-500, 0, -500};
  volume.voxels.assign(volume.grid.count(), {60, 0});
  return volume;
}

Settings quiet(const Probe& probe) {
  Settings settings = trainer_settings(probe.frequency_mhz, probe.depth_mm);
  settings.absorption = settings.clutter = settings.electronic_noise = settings.reverberation = false;
  settings.face_reflection = 0;
  settings.tgc_db = {};
  settings.dynamic_range_db = kDynamicRange_db;
  settings.fixed_level = settings.blend * std::pow(10, 0.4 * kDynamicRange_db / 10);  // the mean at 60 % of the greys
  return settings;
}

/// Intensities |f|^2 on the lines: x line, y sample.
Image<double> intensities(const Stages<float>& stages) {
  Image<double> power(stages.wave_re.width, stages.wave_re.height);
  for (std::size_t i = 0; i < power.pixels.size(); ++i)
    power.pixels[i] = std::norm(std::complex<double>(stages.wave_re.pixels[i], stages.wave_im.pixels[i]));
  return power;
}

struct Band {
  int first_line, last_line, first_sample, last_sample;
};

/// Away from the array's and the lines' ends.
Band inner(const Image<double>& image, double from = 0.05, double to = 0.95) {
  return {image.width / 8, image.width - image.width / 8, int(from * image.height), int(to * image.height)};
}

/// Returns the correlation coefficient of two images, the second taken some lines and samples on.
double correlation(const Image<double>& a, const Image<double>& b, const Band& in, int lines = 0, int samples = 0) {
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0, n = 0;
  for (int k = in.first_sample; k < in.last_sample - samples; ++k)
    for (int line = in.first_line; line < in.last_line - lines; ++line, ++n) {
      const double x = a.at(line, k), y = b.at(line + lines, k + samples);
      mean_a += x, mean_b += y, aa += x * x, bb += y * y, ab += x * y;
    }
  mean_a /= n, mean_b /= n;
  return (ab / n - mean_a * mean_b) / std::sqrt((aa / n - mean_a * mean_a) * (bb / n - mean_b * mean_b));
}

/// Returns twice the distance at which the correlation with itself falls to a half, in steps.
double width_of(const Image<double>& image, const Band& in, bool along) {
  double before = 1;
  for (int step = 1;; ++step) {
    const double now = along ? correlation(image, image, in, 0, step) : correlation(image, image, in, step, 0);
    if (now < 0.5 || step == 60) return 2 * (step - 1 + (before - 0.5) / (before - now));
    before = now;
  }
}

/// Writes rows about one probe.
class Rows {
public:
  Rows(Table& table, const std::string& probe) : table_(table), probe_(probe) {}
  void add(const std::string& quantity, double at, const char* unit, double measured, double expected) {
    std::printf("%-12s %-40s %8.2f %-3s %8.3f  expected %8.3f\n", probe_.c_str(), quantity.c_str(), at, unit, measured,
                expected);
    table_.rows.push_back({probe_, quantity, cell_of(at, 2), unit, cell_of(measured, 4), cell_of(expected, 4)});
  }

private:
  Table& table_;
  std::string probe_;
};

/// Returns the standard deviation of the final picture's greys in dB, without the few pixels below the range.
double deviation_on_display(const Stages<float>& stages) {
  double sum = 0, squares = 0, n = 0;
  for (std::size_t i = 0; i < stages.grey.pixels.size(); ++i) {
    if (!stages.inside.pixels[i] || stages.grey.pixels[i] == 0) continue;
    const double db = stages.grey.pixels[i] * kDynamicRange_db / 255;
    sum += db, squares += db * db, ++n;
  }
  return std::sqrt(squares / n - sum / n * sum / n);
}

/// Rows of the statistics of several patterns: the envelope's and the display's.
void add_statistics(Rows& rows, gl::Simulator& simulator, Settings settings) {
  constexpr std::uint32_t kPatterns = 8;
  std::vector<double> statistics;
  double ratio = 0, deviation_db = 0;
  for (std::uint32_t seed = 1; seed <= kPatterns; ++seed) {
    settings.speckle_seed = seed;
    simulator.set_settings(settings);
    const Stages<float> stages = simulator.read_stages();
    const Image<double> power = intensities(stages);
    const Band in = inner(power);
    std::vector<double> envelope, apart;
    for (int k = in.first_sample; k < in.last_sample; ++k)
      for (int line = in.first_line; line < in.last_line; ++line) {
        envelope.push_back(std::sqrt(power.at(line, k)));
        if (line % 12 == 0 && k % 5 == 0) apart.push_back(envelope.back());
      }
    ratio += envelope_snr(envelope) / kPatterns;
    statistics.push_back(rayleigh_test(apart).statistic);
    deviation_db += deviation_on_display(stages) / kPatterns;
  }
  std::ranges::sort(statistics);
  rows.add("mean of the envelope over its deviation", 0, "", ratio, kRayleighSnr);
  rows.add("Rayleigh statistic (expected: limit)", 0, "", statistics[kPatterns / 2], RayleighTest::kLimit);
  rows.add("deviation on the display in dB", 0, "", deviation_db, 5.57);
}

/// Rows of the contrast of speckle on the display, with the knobs that change it on a still picture, one after another.
void add_knobs(Rows& rows, gl::Simulator& simulator, const Probe& probe, const Settings& plain) {
  const auto add = [&](const std::string& knob, Settings settings, double expected_db) {
    simulator.set_settings(settings);
    rows.add("deviation on the display in dB with " + knob, 0, "", deviation_on_display(simulator.read_stages()),
             expected_db);
  };
  const double one_look_db = kDynamicRange_db * std::sqrt(speckle_variance(plain, 1));
  Settings settings = plain;
  settings.edge_enhancement = with_usual_display(plain).edge_enhancement;
  add("usual edges", settings, one_look_db);  // the filter leaves speckle alone
  settings = plain;
  settings.steering_angles = with_usual_display(plain).steering_angles;
  if (const std::size_t looks = look_angles(probe, settings).size(); looks > 1)
    add(std::to_string(looks) + " looks", settings,
        kDynamicRange_db * std::sqrt(speckle_variance(settings, int(looks))));
  settings = plain;
  settings.speckle_reduction = 0.5;
  add("speckle half reduced (expected: at least)", settings,
      0.5 * one_look_db);  // as much if the local mean were constant
}

/// Rows of a still picture: its brightness along the depth, and the grain.
void add_still(Rows& rows, const Stages<float>& stages, const Probe& probe, const Settings& settings) {
  const Image<double> power = intensities(stages);
  const ScanLines lines = scan_lines(probe, probe.depth_mm, settings.samples);

  const auto mean_db = [&](const Band& band) {
    double total = 0;
    for (int k = band.first_sample; k < band.last_sample; ++k)
      for (int line = band.first_line; line < band.last_line; ++line) total += power.at(line, k);
    return 10 * std::log10(total / double((band.last_sample - band.first_sample) * (band.last_line - band.first_line)));
  };
  const double across_cm = 0.6 * probe.depth_mm / 10;
  rows.add("change of the mean in dB per cm of depth", 0, "",
           (mean_db(inner(power, 0.65, 0.95)) - mean_db(inner(power, 0.05, 0.35))) / across_cm, 0);

  rows.add("grain along the line", 0, "mm", width_of(power, inner(power), true) * lines.dr_mm(),
           settings.reflection_length_mm);
  for (const double share : {0.2, 0.5, 0.8}) {
    const double depth = share * probe.depth_mm;
    const double spacing = lines.fan.step * (lines.fan.apex_mm > 0 ? lines.fan.apex_mm + depth : 1);
    rows.add("grain across at this depth", depth, "mm",
             width_of(power, inner(power, share - 0.1, share + 0.1), false) * spacing,
             std::sqrt(2.0) * focused_beam_fwhm_mm(settings, probe.aperture_mm, depth));
  }
}

/// Rows of a moved probe: how alike the grain is after a distance.
void add_moved(Rows& rows, gl::Simulator& simulator, const Probe& probe, const Settings& settings) {
  const auto at = [&](double x, double z) {
    Pose pose;
    pose.translation = {x, 30, z};
    simulator.set_pose(pose);
    return intensities(simulator.read_stages());
  };
  const Image<double> still = at(0, 0);
  const Band deep = inner(still, 0.75, 0.85);
  // Deep down a sideways move of a fan's probe is one along the arc only in its middle.
  const Band middle{still.width * 3 / 8, still.width * 5 / 8, deep.first_sample, deep.last_sample};
  const double lateral = std::sqrt(2.0) * focused_beam_fwhm_mm(settings, probe.aperture_mm, 0.8 * probe.depth_mm);
  const double sigma = lateral / std::sqrt(8 * std::log(2.0));
  for (const double d : {0.25 * lateral, 0.5 * lateral, lateral})
    rows.add("correlation after a move across", d, "mm", correlation(still, at(d, 0), middle),
             std::exp(-d * d / (2 * sigma * sigma)));
  for (const double d : {0.2, 0.4, 1.0, 1.7, 3.0}) {
    double overlap = 0, whole = 0;
    for (double z = -5; z < 5; z += 0.001) {
      overlap += slice_window(z, settings.slice_thickness_mm) * slice_window(z + d, settings.slice_thickness_mm);
      whole += slice_window(z, settings.slice_thickness_mm) * slice_window(z, settings.slice_thickness_mm);
    }
    rows.add("correlation after a move in elevation", d, "mm", correlation(still, at(0, d), inner(still)),
             std::pow(overlap / whole, 2));
  }
}

}  // namespace

Table measure_grain() {
  Table table{{"probe", "quantity", "at", "unit", "measured", "expected"}, {}};
  const gl::HeadlessContext context;
  tell_device();
  const TissueTable tissues = read_tissue_table(assets_folder() / "tissues.toml");
  for (const Probe& probe : probes()) {
    const Settings settings = quiet(probe);
    gl::Simulator simulator;
    simulator.set_volume(block(), tissues);
    simulator.set_probe(probe, probe.depth_mm);
    simulator.set_settings(settings);
    Pose inside;
    inside.translation.y = 30;
    simulator.set_pose(inside);
    Rows rows(table, probe.name);
    add_statistics(rows, simulator, settings);
    add_knobs(rows, simulator, probe, settings);
    simulator.set_settings(settings);
    add_still(rows, simulator.read_stages(), probe, settings);
    add_moved(rows, simulator, probe, settings);
  }
  return table;
}

}  // namespace insonate::bench
