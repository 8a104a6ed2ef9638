// The commands of insonate-bench about the wave physics of the transducers.

#include "tools/bench/acoustics.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include "sim/acoustics/beam_profile.h"
#include "sim/acoustics/scenes.h"
#include "sim/acoustics/transducer.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/model/beam.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "tests/core/temporary_folder.h"
#include "tools/bench/tables/curves.h"

using namespace insonate;
using namespace insonate::bench;
namespace fs = std::filesystem;

namespace {

std::size_t lines_in(const fs::path& file) {
  const std::string text = read_file(file);
  return std::size_t(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("insonate-bench beam: eight depths per probe, with the profile and the live simulator's widths") {
  const TemporaryFolder folder;
  AcousticRequest request;
  request.attenuation_db_cm_mhz = 0.5;
  const Table table = measure_beams(request, (folder.path / "beams.svg").string());
  REQUIRE(table.rows.size() == 8 * probes().size());
  const Probe& linear = *find_probe("linear");
  const std::size_t row = 8 + 3;  // half of the second probe's depth
  CHECK(table.cell(row, "probe") == "linear");
  const double depth = table.number("", row, "depth_mm");
  CHECK(depth == Approx(linear.depth_mm / 2));

  Beamforming beamforming;
  beamforming.transmit_focus_mm = linear.depth_mm / 2;
  beamforming.transmit_f_number = beamforming.receive_f_number = request.f_number;
  beamforming.attenuation_db_cm_mhz = 0.5;
  beamforming.nearest_mm = linear.depth_mm / 8;
  const Transducer transducer = bundled_transducer("linear");
  const ScanLine line = line_at(transducer, 0);
  const BeamProfile amplitude = beam_profile(transducer, beamforming, line, depth);
  const BeamProfile power = beam_profile(transducer, beamforming, line, depth, kHalfPower);
  const Settings settings = trainer_settings(linear.frequency_mhz, linear.depth_mm);
  const auto check = [&](const char* column, double expected) {
    CAPTURE(column);
    CHECK(table.number("", row, column) == Approx(expected).margin(6e-5));
  };
  check("axial_mm", amplitude.axial_mm);
  check("lateral_mm", amplitude.lateral_mm);
  check("elevation_mm", amplitude.elevation_mm);
  check("axial_3db_mm", power.axial_mm);
  check("lateral_3db_mm", power.lateral_mm);
  check("elevation_3db_mm", power.elevation_mm);
  check("live_lateral_mm", std::sqrt(2.0) * focused_beam_fwhm_mm(settings, linear.aperture_mm, depth));
  check("live_elevation_mm", slice_thickness_at_mm(settings, depth));

  const std::string svg = read_file(folder.path / "beams.svg");
  for (const char* part : {"C5-2v", "L12-3v", "P4-2v", "lateral, live simulator", "</svg>"})
    CHECK(svg.find(part) != std::string::npos);
}

TEST_CASE("insonate-bench beam: depth, focus and f-number are those that were asked for") {
  AcousticRequest request;
  request.probes = {"phased"};
  request.depth_mm = 64;
  request.focus_mm = 48;
  request.f_number = 4;
  const Table table = measure_beams(request, "");
  REQUIRE(table.rows.size() == 8);
  CHECK(table.cell(7, "depth_mm") == "64.00");
  Beamforming beamforming;
  beamforming.transmit_focus_mm = 48;
  beamforming.transmit_f_number = beamforming.receive_f_number = 4;
  beamforming.nearest_mm = 8;
  const Transducer transducer = bundled_transducer("phased");
  CHECK(table.number("", 5, "lateral_mm") ==
        Approx(beam_profile(transducer, beamforming, line_at(transducer, 0), 48).lateral_mm).margin(6e-5));
}

TEST_CASE("insonate-bench speckle: few scatterers are not Rayleigh speckle") {
  AcousticRequest request;
  request.probes = {"linear"};
  request.focus_mm = 12;
  const Table table = measure_speckle(request, 10);
  REQUIRE(table.rows.size() == 4);
  CHECK(table.cell(0, "rayleigh") == "0");
  CHECK(table.number("", 0, "snr") < 1.6);
  CHECK(table.number("", 3, "snr") > 1.7);  // of 200 independent values: a standard error of 0.1
}

TEST_CASE("insonate-bench scene: a folder per probe, or one for a transducer's file") {
  const TemporaryFolder folder;
  AcousticRequest request;
  SceneRequest scene;
  scene.kind = SceneKind::points;
  write_scenes(request, scene, folder.path / "all");
  for (const Probe& probe : probes()) CHECK(lines_in(folder.path / "all" / probe.name / "scatterers.csv") == 9);
  CHECK_THROWS_AS(write_scenes(request, scene, folder.path / "all"), InputError);

  request.transducer = (assets_folder() / "transducers" / "linear.toml").string();
  write_scenes(request, scene, folder.path / "one");
  CHECK(read_file(folder.path / "one" / "transducer.csv") ==
        read_file(folder.path / "all" / "linear" / "transducer.csv"));

  std::string text = read_file(request.transducer);
  text.replace(text.find("\"linear\""), 8, "\"lineal\"");
  request.transducer = (folder.path / "lineal.toml").string();
  write_file(request.transducer, text);
  CHECK_THROWS_WITH(write_scenes(request, scene, folder.path / "two"), Catch::Contains("did you mean 'linear'"));
}

TEST_CASE("plots of curves name their curves and take any name") {
  const std::string svg =
      curves_svg("a < b", {CurvePlot{"P & Q", "x", "y", {Curve{"c < d", "#123", true, {{1, 2}, {3, 4}}}}},
                           CurvePlot{"empty", "x", "y", {}}});
  for (const char* part : {"a &lt; b", "P &amp; Q", "c &lt; d", "stroke-dasharray='5 3'"})
    CHECK(svg.find(part) != std::string::npos);
}
