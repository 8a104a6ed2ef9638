#include <cstdio>
#include <memory>

#include "sim/core/hash.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/upload.h"
#include "sim/wein/wein_simulator.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"
#include "tools/bench/texture_rate.h"

namespace insonate::bench {
namespace {

// Number of images per measured frame, in one call or in that many calls. It is the number that a search requests at
// once, and more where images are cheap.
std::size_t images_per_frame() {
  return gl::is_software_renderer() ? 256 : 512;
}

std::vector<Configuration> usual_sizes() {
  std::vector<Configuration> sizes = {{128, 96, 128, 96}, {64, 64, 64, 64}};
  if (!gl::is_software_renderer()) sizes.push_back({256, 256, 256, 256});  // the paper's tiles
  return sizes;
}

Image<float> random_picture(int width, int height) {
  Image<float> picture(width, height);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = unit_float(hash(std::uint32_t(i)));
  return picture;
}

}  // namespace

Table measure_batch(const Request& request) {
  Table table{{"device", "case", "view", "lines", "samples", "width", "height", "method", "images_per_call", "frames",
               "q1_ms", "median_ms", "q3_ms", "images_per_second", "mpixels_per_second"},
              {}};

  const gl::HeadlessContext context;
  tell_device();
  const std::size_t images = images_per_frame();
  const std::vector<Configuration> sizes = configurations(request, usual_sizes());
  for_each_scene(request, [&](const Scene& scene) {
    gl::Simulator trainer;
    gl::upload_ct(scene.file, scene.volume.grid, [&] { trainer.set_volume(scene.volume, scene.table); });
    std::printf("\n%s, view %s, ms per image of %zu\n", scene.name.c_str(), scene.view.c_str(), images);
    std::printf(
        "lines x samples  picture      what        one a call                all in one call           ratio\n");
    Probe probe = scene.probe;
    for (const Configuration& c : sizes) {
      probe.lines = c.lines;
      Settings training = trainer_settings(probe.frequency_mhz, scene.depth_mm);
      WeinSettings registering;
      training.samples = registering.samples = c.samples;
      training.image_width = registering.image_width = c.width;
      training.image_height = registering.image_height = c.height;
      trainer.set_probe(probe, scene.depth_mm);
      trainer.set_settings(training);
      std::unique_ptr<gl::WeinSimulator> wein;
      std::unique_ptr<gl::TextureRate> fetching;  // as many fetches as the images of one call need
      gl::upload_ct(scene.file, scene.volume.grid, [&] {
        wein = std::make_unique<gl::WeinSimulator>(scene.volume, probe, scene.depth_mm, registering);
        fetching = std::make_unique<gl::TextureRate>(scene.volume, registering.reflection_length_mm,
                                                     images * std::size_t(c.lines) * std::size_t(c.samples));
      });
      wein->set_ultrasound(random_picture(c.width, c.height));

      // With one image per call, each call waits for the device, as in a search that evaluates each image before the
      // next request.
      const auto each = [images](auto&& image_of) {
        return [=](const Pose& pose) {
          for (const Pose& at : poses_around(pose, images)) {
            image_of(at);
            glFinish();
          }
        };
      };
      const auto times = alternating_times(
          scene.pose, request.frames,
          {each([&](const Pose& pose) {
             wein->simulate({&pose, 1});
           }),
           [&](const Pose& pose) { wein->simulate(poses_around(pose, images)); }, each([&](const Pose& pose) {
             wein->similarity({&pose, 1});
           }),
           [&](const Pose& pose) { wein->similarity(poses_around(pose, images)); }, each([&](const Pose& pose) {
             trainer.set_pose(pose);
             trainer.image();
           }),
           [&](const Pose&) { fetching->run(); }});
      std::vector<Spread> ms;
      for (std::vector<double> of_method : times) {
        for (double& time : of_method) time /= double(images);
        ms.push_back(spread_of(of_method));
      }
      // Megapixels per second.
      const auto mpixels_per_second = [&](const Spread& spread) { return c.width * c.height / spread.median / 1000; };
      const auto add = [&](const char* method, std::size_t images_per_call, const Spread& spread) {
        table.rows.push_back({gl::device_description(), scene.name, scene.view, std::to_string(c.lines),
                              std::to_string(c.samples), std::to_string(c.width), std::to_string(c.height), method,
                              std::to_string(images_per_call), std::to_string(request.frames),
                              cell_of(spread.first_quartile, 7), cell_of(spread.median, 7),
                              cell_of(spread.third_quartile, 7), cell_of(1000 / spread.median, 1),
                              cell_of(mpixels_per_second(spread), 2)});
      };
      const auto report = [&](const char* method, const Spread& one, const Spread& all) {
        std::printf("%4d x %-4d      %4d x %-4d  %-10s  %.4f (%.4f to %.4f)  %.4f (%.4f to %.4f)  %5.2f\n", c.lines,
                    c.samples, c.width, c.height, method, one.median, one.first_quartile, one.third_quartile,
                    all.median, all.first_quartile, all.third_quartile, one.median / all.median);
      };
      report("images", ms[0], ms[1]);
      report("LC2", ms[2], ms[3]);
      report("model S", ms[4], ms[1]);
      const double mega_fetches =
          c.lines * c.samples / 1000.0;  // per image; divided by ms, this gives millions per second
      std::printf(
          "                              in one call: %.0f images/s, %.1f MPixel/s; %.0f of the %.0f million fetches/s "
          "that the device makes when it does nothing else: %.0f %%\n",
          1000 / ms[1].median, mpixels_per_second(ms[1]), mega_fetches / ms[1].median, mega_fetches / ms[5].median,
          100 * ms[5].median / ms[1].median);
      add("images", 1, ms[0]);
      add("images", images, ms[1]);
      add("LC2", 1, ms[2]);
      add("LC2", images, ms[3]);
      add("model S", 1, ms[4]);
      add("fetches", images, ms[5]);
    }
  });
  return table;
}

}  // namespace insonate::bench
