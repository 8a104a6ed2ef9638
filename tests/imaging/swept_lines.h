#pragma once

#include <array>
#include <vector>

#include "sim/imaging/line_stages.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/stage_tables.h"
#include "tests/imaging/test_sweeps.h"

namespace insonate::test {

/// A plane of a sweep: its picture, and what the stages that take all planes at once hold of it.
struct SweptPlane {
  Stages<float> picture;
  Image<std::array<float, 4>> scan, echoes;  ///< x line, y sample
};

/// Returns the planes of a sweep by hand, and behind them one of whose lines half meet no body, and one of whose lines
/// none does. Needs an OpenGL context.
inline std::vector<SweptPlane> swept_lines(const Settings& settings, const gl::WorkDivision& division) {
  Sweep sweep = by_hand();
  sweep.patient_from_plane.push_back(on_the_skin(60, 2, 0));
  sweep.patient_from_plane.push_back(on_the_skin(0, -40, 180));
  const int n = sweep.probe.lines, d = settings.samples, planes = int(sweep.patient_from_plane.size());

  const gl::DeviceVolume body(test_body(), tissues());
  gl::LineStages stages({}, division);
  stages.lay_out(scan_lines(sweep.probe, sweep.depth_mm, d), planes, settings);
  gl::SimulationParameters parameters = gl::parameters_of(settings, stages.lines(), {}, {});
  parameters.planes = planes;
  const gl::Buffer block(sizeof parameters, &parameters);
  block.bind_uniform(0);
  stages.traverse(body, sweep.patient_from_plane, settings);
  stages.beam(settings);
  std::vector<std::array<float, 4>> scan(std::size_t(planes * n * d)), echoes(scan.size());
  stages.scan().read(scan.data(), scan.size() * sizeof scan[0]);
  stages.echoes().read(echoes.data(), echoes.size() * sizeof echoes[0]);

  gl::Simulator simulator({}, division);
  simulator.set_volume(test_body(), tissues());
  simulator.set_probe(sweep.probe, sweep.depth_mm);
  simulator.set_settings(settings);
  std::vector<SweptPlane> swept;
  for (int plane = 0; plane < planes; ++plane) {
    simulator.set_pose(sweep.patient_from_plane[std::size_t(plane)]);
    SweptPlane& made = swept.emplace_back(SweptPlane{
        Stages<float>(simulator.read_stages()), Image<std::array<float, 4>>(n, d), Image<std::array<float, 4>>(n, d)});
    for (int line = 0; line < n; ++line)
      for (int k = 0; k < d; ++k) {
        const std::size_t at = std::size_t((plane * n + line) * d + k);
        made.scan.at(line, k) = scan[at];
        made.echoes.at(line, k) = echoes[at];
      }
  }
  return swept;
}

}  // namespace insonate::test
