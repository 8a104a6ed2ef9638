#include "tools/bench/acoustics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/acoustics/beam_profile.h"
#include "sim/acoustics/scene_files.h"
#include "sim/acoustics/speckle_sample.h"
#include "sim/acoustics/speckle_statistics.h"
#include "sim/acoustics/transducer.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/model/beam.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "tools/bench/tables/curves.h"

namespace insonate::bench {
namespace {

constexpr int kDepths = 8;  // rows per transducer, from an eighth of the depth to all of it

/// A transducer as the trainer would use it.
struct Subject {
  Transducer transducer;
  Beamforming beamforming;
  Settings settings;  // of the trainer's simulator at this depth
  double depth_mm;
  double aperture_mm;  // of the trainer's probe
};

Subject subject_of(const Transducer& transducer, const AcousticRequest& request) {
  const Probe* probe = find_probe(transducer.name);
  if (!probe)
    throw InputError(request.transducer, "'name'", "'" + transducer.name + "' is not a probe of the trainer",
                     suggest(transducer.name, probe_names()));
  const double depth = request.depth_mm > 0 ? request.depth_mm : probe->depth_mm;
  Settings settings = trainer_settings(probe->frequency_mhz, depth);
  settings.f_number = request.f_number;
  if (request.focus_mm > 0) settings.focus_mm = request.focus_mm;
  Beamforming beamforming;
  beamforming.transmit_focus_mm = settings.focus_mm;
  beamforming.transmit_f_number = beamforming.receive_f_number = settings.f_number;
  beamforming.attenuation_db_cm_mhz = request.attenuation_db_cm_mhz;
  beamforming.nearest_mm = std::min(beamforming.nearest_mm, depth / kDepths);
  return {transducer, beamforming, settings, depth, probe->aperture_mm};
}

std::vector<Subject> subjects_of(const AcousticRequest& request) {
  if (!request.transducer.empty()) return {subject_of(read_transducer(request.transducer), request)};
  std::vector<Subject> subjects;
  for (const std::string& name : request.probes.empty() ? probe_names() : request.probes)
    subjects.push_back(subject_of(bundled_transducer(name), request));
  return subjects;
}

std::string in_words(const Subject& subject) {
  return formatted("%s (%s, %.2f MHz), focus %.0f mm, f/%g", subject.transducer.name.c_str(),
                   subject.transducer.title.c_str(), subject.transducer.frequency_mhz,
                   subject.beamforming.transmit_focus_mm, subject.beamforming.transmit_f_number);
}

// A row of the table of beams.
struct BeamRow {
  BeamProfile amplitude, power;  // widths at -6 and -3 dB
  double live_lateral_mm, live_elevation_mm;
};

BeamRow beam_row(const Subject& subject, double depth_mm) {
  const ScanLine line = line_at(subject.transducer, 0);
  return {beam_profile(subject.transducer, subject.beamforming, line, depth_mm, kHalfAmplitude),
          beam_profile(subject.transducer, subject.beamforming, line, depth_mm, kHalfPower),
          std::sqrt(2.0) * focused_beam_fwhm_mm(subject.settings, subject.aperture_mm, depth_mm),
          slice_thickness_at_mm(subject.settings, depth_mm)};
}

CurvePlot plot_of(const Subject& subject, int points) {
  const char *kLateral = "#2567a8", *kElevation = "#b3362b", *kAxial = "#5f6c7b";
  CurvePlot plot{in_words(subject), "depth, mm", "full width at half amplitude, mm", {}};
  plot.curves = {Curve{"lateral", kLateral, false, {}}, Curve{"elevation", kElevation, false, {}},
                 Curve{"axial", kAxial, false, {}}, Curve{"lateral, live simulator", kLateral, true, {}},
                 Curve{"elevation, live simulator", kElevation, true, {}}};
  std::vector<BeamRow> rows(std::size_t(points), BeamRow{});
  const auto depth = [&](int i) { return subject.depth_mm * (1 + (kDepths - 1.0) * i / (points - 1)) / kDepths; };
  tbb::parallel_for(0, points, [&](int i) { rows[std::size_t(i)] = beam_row(subject, depth(i)); });
  for (int i = 0; i < points; ++i) {
    const BeamRow& row = rows[std::size_t(i)];
    const double values[] = {row.amplitude.lateral_mm, row.amplitude.elevation_mm, row.amplitude.axial_mm,
                             row.live_lateral_mm, row.live_elevation_mm};
    for (std::size_t curve = 0; curve < plot.curves.size(); ++curve)
      plot.curves[curve].points.emplace_back(depth(i), values[curve]);
  }
  return plot;
}

}  // namespace

Table measure_beams(const AcousticRequest& request, const std::string& svg) {
  constexpr int kPlotted = 57;
  Table table{{"probe", "depth_mm", "axial_mm", "lateral_mm", "elevation_mm", "axial_3db_mm", "lateral_3db_mm",
               "elevation_3db_mm", "live_lateral_mm", "live_elevation_mm"},
              {}};
  std::vector<CurvePlot> plots;
  for (const Subject& subject : subjects_of(request)) {
    std::printf("%s\n%9s | %-26s | %-26s | %-18s\n%9s | %8s %8s %8s | %8s %8s %8s | %8s %8s\n",
                in_words(subject).c_str(), "", "full width at -6 dB, mm", "full width at -3 dB, mm",
                "live simulator, mm", "depth mm", "axial", "lateral", "elev.", "axial", "lateral", "elev.", "lateral",
                "elev.");
    for (int i = 1; i <= kDepths; ++i) {
      const double depth = subject.depth_mm * i / kDepths;
      const BeamRow row = beam_row(subject, depth);
      std::printf("%9.1f | %8.3f %8.3f %8.3f | %8.3f %8.3f %8.3f | %8.3f %8.3f\n", depth, row.amplitude.axial_mm,
                  row.amplitude.lateral_mm, row.amplitude.elevation_mm, row.power.axial_mm, row.power.lateral_mm,
                  row.power.elevation_mm, row.live_lateral_mm, row.live_elevation_mm);
      table.rows.push_back({subject.transducer.name, cell_of(depth, 2), cell_of(row.amplitude.axial_mm, 4),
                            cell_of(row.amplitude.lateral_mm, 4), cell_of(row.amplitude.elevation_mm, 4),
                            cell_of(row.power.axial_mm, 4), cell_of(row.power.lateral_mm, 4),
                            cell_of(row.power.elevation_mm, 4), cell_of(row.live_lateral_mm, 4),
                            cell_of(row.live_elevation_mm, 4)});
    }
    if (!svg.empty()) plots.push_back(plot_of(subject, kPlotted));
  }
  if (!svg.empty()) write_file(svg, curves_svg("The resolution cell of a scan line, both ways", plots));
  return table;
}

Table measure_speckle(const AcousticRequest& request, int lines) {
  constexpr double kCells = 15;  // to either side of the focus, along the line
  Table table{{"probe", "scatterers_per_cell", "values", "snr", "independent", "distance", "statistic", "rayleigh"},
              {}};
  std::printf("Rayleigh: SNR %.3f, statistic at most %.3f\n%-12s %8s %8s %7s %11s %9s %9s  %s\n", kRayleighSnr,
              RayleighTest::kLimit, "probe", "per cell", "values", "SNR", "independent", "distance", "statistic",
              "Rayleigh?");
  for (const Subject& subject : subjects_of(request))
    for (const double per_cell : {0.5, 2.0, 10.0, 40.0}) {
      const SpeckleSample speckle = sample_speckle(subject.transducer, subject.beamforming, per_cell, lines, kCells);
      const double snr = envelope_snr(speckle.all);
      const RayleighTest test = rayleigh_test(speckle.independent);
      std::printf("%-12s %8g %8zu %7.3f %11zu %9.4f %9.3f  %s\n", subject.transducer.name.c_str(), per_cell,
                  speckle.all.size(), snr, speckle.independent.size(), test.distance, test.statistic,
                  test.is_rayleigh() ? "yes" : "no");
      table.rows.push_back({subject.transducer.name, cell_of(per_cell, 1), std::to_string(speckle.all.size()),
                            cell_of(snr, 4), std::to_string(speckle.independent.size()), cell_of(test.distance, 5),
                            cell_of(test.statistic, 4), test.is_rayleigh() ? "1" : "0"});
    }
  return table;
}

void write_scenes(const AcousticRequest& request, SceneRequest scene, const std::filesystem::path& folder) {
  const std::vector<Subject> subjects = subjects_of(request);
  for (const Subject& subject : subjects) {
    scene.depth_mm = subject.depth_mm;
    const std::vector<PointScatterer> scatterers = scene_of(subject.transducer, subject.beamforming, scene);
    const std::filesystem::path to = subjects.size() > 1 ? folder / subject.transducer.name : folder;
    write_scene(to, subject.transducer, subject.beamforming, scatterers, subject.depth_mm + 5);
    std::printf("%s: %zu scatterers; %s\n", to.c_str(), scatterers.size(), in_words(subject).c_str());
  }
}

}  // namespace insonate::bench
