#include <tbb/info.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "sim/files/files.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/upload.h"
#include "sim/wein/wein_simulator.h"
#include "tools/bench/commands.h"
#include "tools/bench/processor/wein_on_processor.h"
#include "tools/bench/tables/curves.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

// One image per call; the paper's tiles are the fourth.
const std::vector<Configuration> kSingleImages = {{32, 32, 32, 32},     {64, 64, 64, 64},     {128, 128, 128, 128},
                                                  {256, 256, 256, 256}, {512, 512, 512, 512}, {1024, 1024, 1024, 1024}};

// Tiles of 256 x 256 in one call, as columns x rows of the grid.
struct Tiles {
  int columns, rows;
};
constexpr Tiles kTiles[] = {{1, 1}, {2, 1}, {2, 2}, {4, 2}, {4, 4}, {8, 4}, {8, 8}, {16, 8}, {16, 16}, {32, 16}};
constexpr Configuration kTile = {256, 256, 256, 256};

// A frame of the plain implementation has at most this many images, or it would take half a minute. It draws them one
// after the other, so that the time per image does not depend on their number.
constexpr std::size_t kMaxPlainImages = 2;

constexpr const char* kMethods[] = {"OpenGL", "plain", "vectorised"};

// The throughput of each method over the size of single images, and over their number in one call.
struct Curves {
  std::vector<Curve> by_size, by_images;

  Curves() {
    constexpr const char* kColours[] = {"#1f6fb4", "#8a8a8a", "#c8641e"};
    for (std::size_t method = 0; method < 3; ++method)
      by_size.push_back({kMethods[method], kColours[method], method == 1, {}});
    by_images = by_size;
  }
};

}  // namespace

Table measure_throughput(const Request& request, const std::string& svg) {
  Table table{
      {"device", "case", "view", "lines", "samples", "width", "height", "method", "images_per_call", "frames", "q1_ms",
       "median_ms", "q3_ms", "images_per_second", "mpixels_per_second", "speed_up_of_plain", "speed_up_of_vectorised"},
      {}};
  std::vector<CurvePlot> plots;
  const gl::HeadlessContext context;
  tell_device();
  std::printf("the processor's own implementations run beside it: plain on 1 core, vectorised on %d\n",
              tbb::info::default_concurrency());
  for_each_scene(request, [&](const Scene& scene) {
    const DensityVoxels ct(scene.volume, WeinSettings{}.reflection_length_mm);
    std::printf("\n%s, view %s, ms per image\n", scene.name.c_str(), scene.view.c_str());
    std::printf(
        "lines x samples  picture      images  OpenGL                     MPixel/s  plain processor  ratio  vectorised "
        "      ratio\n");
    Curves curves;
    const auto measure = [&](const Configuration& c, std::size_t images, std::vector<Curve>& of_method, double x) {
      Probe probe = scene.probe;
      probe.lines = c.lines;
      WeinSettings settings;
      settings.samples = c.samples;
      settings.image_width = c.width;
      settings.image_height = c.height;
      std::unique_ptr<gl::WeinSimulator> device;
      gl::upload_ct(scene.file, scene.volume.grid, [&] {
        device = std::make_unique<gl::WeinSimulator>(scene.volume, probe, scene.depth_mm, settings);
      });
      const ProcessorFan fan(probe, scene.depth_mm, settings);
      const std::size_t plain_images = std::min(images, kMaxPlainImages);
      std::vector<std::uint8_t> pictures(images * std::size_t(c.width) * std::size_t(c.height));
      const auto times = alternating_times(
          scene.pose, request.frames,
          {[&](const Pose& pose) { device->simulate(poses_around(pose, images)); },
           [&](const Pose& pose) { simulate_plainly(ct, fan, settings, poses_around(pose, plain_images), pictures); },
           [&](const Pose& pose) { simulate_vectorised(ct, fan, settings, poses_around(pose, images), pictures); }});
      std::vector<Spread> ms;
      for (std::size_t method = 0; method < 3; ++method) {
        std::vector<double> an_image = times[method];
        for (double& time : an_image) time /= double(method == 1 ? plain_images : images);
        ms.push_back(spread_of(an_image));
      }
      const auto mpixels_per_second = [&](const Spread& spread) { return c.width * c.height / spread.median / 1000; };
      std::printf("%4d x %-4d      %4d x %-4d  %5zu   %8.4f (%.4f to %.4f)  %8.1f  %8.3f  %9.1f  %9.4f  %9.2f\n",
                  c.lines, c.samples, c.width, c.height, images, ms[0].median, ms[0].first_quartile,
                  ms[0].third_quartile, mpixels_per_second(ms[0]), ms[1].median, ms[1].median / ms[0].median,
                  ms[2].median, ms[2].median / ms[0].median);
      for (std::size_t method = 0; method < 3; ++method) {
        of_method[method].points.emplace_back(x, mpixels_per_second(ms[method]));
        table.rows.push_back({gl::device_description(), scene.name, scene.view, std::to_string(c.lines),
                              std::to_string(c.samples), std::to_string(c.width), std::to_string(c.height),
                              kMethods[method], std::to_string(method == 1 ? plain_images : images),
                              std::to_string(request.frames), cell_of(ms[method].first_quartile, 5),
                              cell_of(ms[method].median, 5), cell_of(ms[method].third_quartile, 5),
                              cell_of(1000 / ms[method].median, 1), cell_of(mpixels_per_second(ms[method]), 2),
                              cell_of(ms[1].median / ms[method].median, 4),
                              cell_of(ms[2].median / ms[method].median, 4)});
      }
    };
    for (const Configuration& c : configurations(request, kSingleImages))
      measure(c, 1, curves.by_size, std::sqrt(double(c.width) * c.height));
    if (request.configurations.empty())
      for (const Tiles& tiles : kTiles) {
        const std::size_t images = std::size_t(tiles.columns) * std::size_t(tiles.rows);
        measure(kTile, images, curves.by_images, std::log2(double(images)));
      }
    plots.push_back({scene.name + ", one image", "side of the image, pixels", "MPixel/s", curves.by_size});
    if (request.configurations.empty())
      plots.push_back({scene.name + ", 256 x 256", "images in one call, log2", "MPixel/s", curves.by_images});
  });
  if (!svg.empty()) write_file(svg, curves_svg(gl::device_description(), plots));
  return table;
}

}  // namespace insonate::bench
