#include "sim/acoustics/scenes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "sim/core/input_error.h"
#include "tests/acoustics/helpers.h"

using namespace insonate;
using test::shipped;

namespace {

// The mean square of lines between two depths.
double mean_square(const std::vector<EchoLine>& lines, double from_mm, double to_mm) {
  double sum = 0, count = 0;
  for (const EchoLine& line : lines)
    for (std::size_t k = 0; k < line.samples.size(); ++k)
      if (line.distance_mm(double(k)) > from_mm && line.distance_mm(double(k)) < to_mm) {
        sum += std::norm(line.samples[k]);
        ++count;
      }
  return sum / count;
}

SceneRequest request_of(SceneKind kind) {
  SceneRequest request;
  request.kind = kind;
  request.depth_mm = 40;
  request.width_mm = 12;
  request.per_cell = 2;
  return request;
}

}  // namespace

TEST_CASE("a block has its density everywhere, as many of either sign, and depends on its seed") {
  const SceneBox box{{-5, 20, -2}, {5, 30, 2}};
  const std::vector<PointScatterer> block = uniform_block(box, 50, 3);
  REQUIRE(block.size() == 20000);
  std::map<int, int> octants;
  double sum = 0;
  for (const PointScatterer& scatterer : block) {
    CHECK(std::abs(scatterer.amplitude) == 1);
    const glm::dvec3 share = (scatterer.position_mm - box.low) / (box.high - box.low);
    REQUIRE(std::min({share.x, share.y, share.z}) >= 0);
    REQUIRE(std::max({share.x, share.y, share.z}) < 1);
    ++octants[4 * (share.x > 0.5) + 2 * (share.y > 0.5) + (share.z > 0.5)];
    sum += scatterer.amplitude;
  }
  // Five standard deviations of a binomial count.
  for (const auto& [octant, count] : octants) CHECK(count == Approx(2500).margin(5 * std::sqrt(20000 * 7 / 64.0)));
  CHECK(std::abs(sum) < 5 * std::sqrt(20000.0));
  CHECK(uniform_block(box, 50, 3) == block);
  CHECK(uniform_block(box, 50, 4) != block);
}

TEST_CASE("cysts hold no scatterers, or stronger ones") {
  const SceneBox box{{-5, 20, -2}, {5, 30, 2}};
  const std::vector<PointScatterer> phantom = cyst_phantom(box, 50, {{-2, 25, 1.5, 0}, {2, 25, 1.5, 4}}, 3);
  int strong = 0;
  for (const PointScatterer& scatterer : phantom) {
    CHECK(std::hypot(scatterer.position_mm.x + 2, scatterer.position_mm.y - 25) >= 1.5);
    const bool within = std::hypot(scatterer.position_mm.x - 2, scatterer.position_mm.y - 25) < 1.5;
    CHECK(std::abs(scatterer.amplitude) == (within ? 4 : 1));
    strong += within;
  }
  // pi 1.5^2 4 50 scatterers lie in each cylinder.
  CHECK(strong == Approx(1414).margin(5 * std::sqrt(1414.0)));
  CHECK(20000 - phantom.size() == Approx(1414).margin(5 * std::sqrt(1414.0)));
}

TEST_CASE("lines through a cyst are dark in it, and through a bright cylinder bright") {
  Transducer transducer;
  transducer.elements = 32;
  transducer.pitch_mm = 0.3;
  transducer.kerf_mm = 0.03;
  transducer.height_mm = 3;
  transducer.elevation_focus_mm = 20;
  transducer.frequency_mhz = 6;
  Beamforming beamforming;
  beamforming.transmit_focus_mm = 20;
  beamforming.transmit_f_number = beamforming.receive_f_number = 2.5;
  const SceneBox box{{-5, 15.5, -1}, {5, 24.5, 1}};
  const std::vector<PointScatterer> phantom = cyst_phantom(box, 60, {{-2, 20, 2, 0}, {2, 20, 2, 3.16227766}}, 1);
  const auto lines_at = [&](double x) {
    return echo_lines(transducer, beamforming,
                      {line_at(transducer, x - 0.4), line_at(transducer, x), line_at(transducer, x + 0.4)}, phantom, 15,
                      25);
  };
  const auto dark = lines_at(-2), bright = lines_at(2);
  const double background = (mean_square(dark, 16, 17) + mean_square(dark, 23, 24) + mean_square(bright, 16, 17) +
                             mean_square(bright, 23, 24)) /
                            4;
  // Side lobes fill a cyst some 25 dB below; the bright cylinder's 10 dB are those of 3 lines of 10 cells each.
  CHECK(10 * std::log10(mean_square(dark, 19.2, 20.8) / background) < -20);
  CHECK(10 * std::log10(mean_square(bright, 18.8, 21.2) / background) == Approx(10).margin(2.5));
}

TEST_CASE("point targets and wires lie at 8 depths, and echo from there") {
  const Transducer transducer = shipped("linear");
  Beamforming beamforming;
  beamforming.transmit_focus_mm = 25;
  for (const SceneKind kind : {SceneKind::points, SceneKind::wires}) {
    const std::vector<PointScatterer> scene = scene_of(transducer, beamforming, request_of(kind));
    std::map<double, int> depths;
    for (const PointScatterer& scatterer : scene) {
      ++depths[scatterer.position_mm.y];
      CHECK(scatterer.position_mm.x == 0);
    }
    REQUIRE(depths.size() == 8);
    CHECK(depths.begin()->first == Approx(10));
    CHECK(depths.rbegin()->first == Approx(40));
    const ScanBeam beam(transducer, beamforming, line_at(transducer, 0));
    const EchoLine line = echo_line(beam, Pulse(transducer), scene, 8, 42);
    for (const auto& [depth, count] : depths) {
      double most = 0, at = 0;
      for (std::size_t k = 0; k < line.samples.size(); ++k)
        if (std::abs(line.distance_mm(double(k)) - depth) < 1.5 && std::abs(line.samples[k]) > most) {
          most = std::abs(line.samples[k]);
          at = line.distance_mm(double(k));
        }
      CAPTURE(int(kind), depth);
      // The lens has its focus at 20 mm. Elsewhere its rows, and the wire's ends, echo later or earlier.
      CHECK(at == Approx(depth).margin(0.15));
      CHECK(most > 10 * std::sqrt(mean_square({line}, depth + 1.7, depth + 2.5)));
    }
  }
}

TEST_CASE("a wire's echo does not depend on how finely it is divided") {
  const Transducer transducer = shipped("linear");
  Beamforming beamforming;
  beamforming.transmit_focus_mm = 20;
  const ScanBeam beam(transducer, beamforming, line_at(transducer, 0));
  const auto echo = [&](double spacing_mm) {
    const EchoLine line = echo_line(beam, Pulse(transducer), wire_targets({20}, 3, spacing_mm), 18, 22);
    const std::vector<double> envelope = line.envelope();
    return *std::max_element(envelope.begin(), envelope.end());
  };
  CHECK(echo(transducer.wavelength_mm() / 4) == Approx(echo(transducer.wavelength_mm() / 16)).epsilon(0.01));
}

TEST_CASE("blocks and cysts have their scatterers per resolution cell") {
  for (const char* name : {"curvilinear", "linear", "phased"}) {
    const Transducer transducer = shipped(name);
    Beamforming beamforming;
    beamforming.transmit_focus_mm = 25;
    const std::vector<PointScatterer> block = scene_of(transducer, beamforming, request_of(SceneKind::block));
    const double cell = cell_volume_mm3(beam_profile(transducer, beamforming, line_at(transducer, 0), 25));
    int within = 0;  // the middle eighth of the width and the depth, half a millimetre thick
    for (const PointScatterer& scatterer : block)
      within += std::abs(scatterer.position_mm.x) < 3 && std::abs(scatterer.position_mm.y - 25) < 7.5 &&
                std::abs(scatterer.position_mm.z) < 0.5;
    const double expected = 2 / cell * 6 * 15 * 1;
    CAPTURE(name);
    CHECK(within == Approx(expected).margin(5 * std::sqrt(expected)));

    // Echo-free cylinders on the left, bright ones on the right, at 3 depths from 10 to 40 mm.
    SceneRequest cysts = request_of(SceneKind::cyst);
    const std::vector<PointScatterer> phantom = scene_of(transducer, beamforming, cysts);
    CHECK(phantom.size() < block.size());
    int bright = 0;
    for (const PointScatterer& scatterer : phantom)
      for (const double depth : {15.0, 25.0, 35.0}) {
        CHECK(std::hypot(scatterer.position_mm.x + 3, scatterer.position_mm.y - depth) >= 1.2);
        if (std::hypot(scatterer.position_mm.x - 3, scatterer.position_mm.y - depth) >= 1.2) continue;
        CHECK(std::abs(scatterer.amplitude) == Approx(std::sqrt(10)));
        ++bright;
      }
    CHECK(bright > 0);
    cysts.seed = 2;
    CHECK(scene_of(transducer, beamforming, cysts) != phantom);
  }
  SceneRequest large = request_of(SceneKind::block);
  large.per_cell = 1000;
  large.width_mm = 200;
  CHECK_THROWS_AS(scene_of(shipped("linear"), {}, large), InputError);
  CHECK(scene_names().size() == 4);
}
