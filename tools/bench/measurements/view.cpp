#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/upload.h"
#include "sim/view/body/ct_reference.h"
#include "sim/view/body/transfer_function_file.h"
#include "sim/view/body/volume_view.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

// As in the paper's Table 1.
constexpr int kTableWidth = 640, kTableHeight = 480, kSteps = 512;
// Errors are measured on smaller pictures, because the reference takes tens of milliseconds per pixel.
constexpr int kErrorWidth = 128, kErrorHeight = 96;
constexpr double kFinerSteps = 10;  // steps of the reference per half voxel

Volume<std::int16_t> ct_of(const AcousticVolume& acoustic) {
  Volume<std::int16_t> ct;
  ct.grid = acoustic.grid;
  ct.voxels.reserve(acoustic.voxels.size());
  for (const AcousticVoxel& voxel : acoustic.voxels) ct.voxels.push_back(voxel.hu);
  return ct;
}

/// A patient with everything that a frame of simulation and visualisation needs.
struct Stage {
  Volume<std::int16_t> ct;
  gl::Simulator simulator;
  std::optional<view::PatientTextures> patient;
  view::VolumeView view;
  view::OrbitCamera camera;
  view::VolumeStyle style;
  Probe probe;
  double depth_mm;
  Settings settings;
  Pose start, pose;

  Stage(const Scene& scene, const view::TransferFunction& look)
      : ct(ct_of(scene.volume)), probe(scene.probe), depth_mm(scene.depth_mm), start(scene.pose), pose(start) {
    gl::upload_ct(scene.file, scene.volume.grid, [&] { simulator.set_volume(scene.volume, scene.table); });
    patient.emplace(simulator.volume_texture(), ct, Volume<std::uint8_t>(), view::OrganColours());
    probe.lines = 512;
    settings = settings_of(scene, {512, 512, kTableWidth, kTableHeight}, false);
    camera = view::OrbitCamera::facing(ct.grid, pose);
    style.cut = false;
    style.ct.emplace();
    style.ct->function = look;
    const double diagonal_mm = glm::length(glm::dvec3(ct.grid.size) * ct.grid.spacing);
    style.ct->step = diagonal_mm / kSteps / patient->ct_voxel_mm();
  }

  void draw() {
    simulator.set_probe(probe, depth_mm);
    simulator.set_settings(settings);
    simulator.set_pose(pose);
    view::UltrasoundPlane plane;
    plane.image = &simulator.image();
    plane.image_version = simulator.image_version();
    plane.geometry = simulator.geometry();
    plane.probe = probe;
    plane.patient_from_probe = pose;
    view.render(kTableWidth, kTableHeight, *patient, camera, plane, style);
    glFinish();
  }
};

/// A row of the paper's Table 1: what changes from frame to frame.
struct TableRow {
  const char* name;
  std::function<void(Stage&, int frame)> make;
};

const std::array<TableRow, 6> kTableRows{{
    {"nothing", [](Stage&, int) {}},
    {"volume pose", [](Stage& s, int) { s.camera.orbit(1, 0.3); }},
    {"transducer pose", [](Stage& s, int frame) { s.pose = wandering(s.start, frame); }},
    {"transducer shape", [](Stage& s, int frame) { s.depth_mm += frame % 2 ? 1 : -1; }},
    {"simulation parameter", [](Stage& s, int frame) { s.settings.blend *= frame % 2 ? 1.1 : 1 / 1.1; }},
    {"transfer function",
     [](Stage& s, int frame) { s.style.ct->function = s.style.ct->function.moved(frame % 2 ? 5 : -5, 1); }},
}};

double milliseconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<view::TransferFunction> looks_to_measure() {
  std::vector<view::TransferFunction> looks;
  for (view::TransferFunction& look : view::bundled_transfer_functions())
    if (look.name == "Skin" || look.name == "Bones" || look.name == "Organs") looks.push_back(std::move(look));
  return looks;
}

}  // namespace

Table measure_view(const Request& request) {
  Table table{{"device", "case", "look", "changes", "width", "height", "steps", "frames", "q1_ms", "median_ms", "q3_ms",
               "per_second", "without_leaps_ms"},
              {}};
  const gl::HeadlessContext context;
  tell_device();
  for_each_scene(request, [&](const Scene& scene) {
    for (const view::TransferFunction& look : looks_to_measure()) {
      std::printf("\n%s, %s: simulation and volume rendering, %d x %d, up to %d steps a ray\n", scene.name.c_str(),
                  look.name.c_str(), kTableWidth, kTableHeight, kSteps);
      std::printf("%-22s %10s  %-20s %8s  %s\n", "what changes", "median ms", "(quartiles)", "frames/s",
                  "without leaps, ms");
      Stage stage(scene, look);
      for (const TableRow& change : kTableRows) {
        std::vector<double> leaping, stepping;
        int changes = 0;
        const auto time_of_change = [&](bool leaps) {
          change.make(stage, changes++);
          stage.style.ct->skips_empty = leaps;
          return milliseconds_of([&] { stage.draw(); });
        };
        for (int frame = -2; frame < request.frames; ++frame) {
          if (frame % 4 == 0 && &change != &kTableRows[0])  // what leaps save, in the same run
            stepping.push_back(time_of_change(false));
          const double ms = time_of_change(true);
          if (frame >= 0) leaping.push_back(ms);  // the first ones compile
        }
        const Spread ms = spread_of(leaping);
        const double without = spread_of(stepping).median;
        std::printf("%-22s %10.2f  (%.2f to %.2f) %8.1f  %10.1f\n", change.name, ms.median, ms.first_quartile,
                    ms.third_quartile, 1000 / ms.median, without);
        table.rows.push_back({gl::device_description(), scene.name, look.name, change.name, std::to_string(kTableWidth),
                              std::to_string(kTableHeight), std::to_string(kSteps), std::to_string(request.frames),
                              cell_of(ms.first_quartile, 3), cell_of(ms.median, 3), cell_of(ms.third_quartile, 3),
                              cell_of(1000 / ms.median, 1), stepping.empty() ? "" : cell_of(without, 3)});
      }
    }
  });
  return table;
}

Table measure_view_front(const Request& request) {
  Table table{{"device", "case", "look", "step", "classification", "shaded", "jittered", "frames", "q1_ms", "median_ms",
               "q3_ms", "psnr_db", "largest_difference", "front"},
              {}};
  const gl::HeadlessContext context;
  tell_device();
  for_each_scene(request, [&](const Scene& scene) {
    for (const view::TransferFunction& look : looks_to_measure()) {
      Stage stage(scene, look);
      stage.style.plane = stage.style.probe = false;
      stage.style.ct->body_only = false;
      const double half_voxel_mm = 0.5 * stage.patient->ct_voxel_mm();
      const view::CtReference reference(stage.ct, *stage.style.ct, stage.camera, kErrorWidth, kErrorHeight,
                                        half_voxel_mm / kFinerSteps);
      std::vector<glm::dvec3> truth(std::size_t(kErrorWidth) * kErrorHeight);
      tbb::parallel_for(0, kErrorHeight, [&](int y) {
        for (int x = 0; x < kErrorWidth; ++x)
          truth[std::size_t(y) * kErrorWidth + std::size_t(x)] =
              255.0 * glm::clamp(reference.colour(x + 0.5, y + 0.5), 0.0, 1.0);
      });
      std::printf("\n%s, %s: a picture of %d x %d, error of one of %d x %d\n", scene.name.c_str(), look.name.c_str(),
                  kTableWidth, kTableHeight, kErrorWidth, kErrorHeight);
      std::printf("step, voxels  classification  shaded  jittered  median ms  PSNR, dB  largest\n");
      std::vector<Cost> costs;
      const std::size_t first_row = table.rows.size();
      for (const double step : {0.25, 0.5, 0.75, 1.0, 1.5, 2.0})
        for (const auto classification : {view::Classification::pre_integrated, view::Classification::post})
          for (const bool shaded : {true, false})
            for (const bool jittered : {true, false}) {
              view::CtVolumeStyle& ct = *stage.style.ct;
              ct.step = step;
              ct.classification = classification;
              ct.shaded = shaded;
              ct.jittered = jittered;
              std::vector<double> times;
              for (int frame = -1; frame < request.frames; ++frame) {
                stage.view.forget();
                const double ms = milliseconds_of([&] {
                  stage.view.render(kTableWidth, kTableHeight, *stage.patient, stage.camera, view::UltrasoundPlane(),
                                    stage.style);
                  glFinish();
                });
                if (frame >= 0) times.push_back(ms);
              }
              const gl::Texture& drawn = stage.view.render(kErrorWidth, kErrorHeight, *stage.patient, stage.camera,
                                                           view::UltrasoundPlane(), stage.style);
              std::vector<std::array<std::uint8_t, 4>> pixels(truth.size());
              drawn.read(GL_RGBA, GL_UNSIGNED_BYTE, pixels.data(), pixels.size() * 4);
              RootMeanSquare error;
              double largest = 0;
              for (std::size_t i = 0; i < truth.size(); ++i)
                for (int c = 0; c < 3; ++c) {
                  const double difference = pixels[i][std::size_t(c)] - truth[i][c];
                  error.add(difference);
                  largest = std::max(largest, std::abs(difference));
                }
              const Spread ms = spread_of(times);
              const double psnr = 20 * std::log10(255 / error.value());
              const char* kind = classification == view::Classification::post ? "post" : "pre-integrated";
              std::printf("%-12.2f  %-14s  %-6s  %-8s  %9.1f  %8.1f  %7.1f\n", step, kind, shaded ? "yes" : "no",
                          jittered ? "yes" : "no", ms.median, psnr, largest);
              table.rows.push_back({gl::device_description(), scene.name, look.name, cell_of(step, 2), kind,
                                    shaded ? "1" : "0", jittered ? "1" : "0", std::to_string(request.frames),
                                    cell_of(ms.first_quartile, 3), cell_of(ms.median, 3), cell_of(ms.third_quartile, 3),
                                    cell_of(psnr, 2), cell_of(largest, 1), ""});
              costs.push_back({ms, error.value(), 0});
            }
      const std::vector<bool> front = on_front(costs);
      for (std::size_t i = 0; i < front.size(); ++i) table.rows[first_row + i].back() = front[i] ? "1" : "0";
    }
  });
  return table;
}

}  // namespace insonate::bench
