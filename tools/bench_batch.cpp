#include <cstdio>
#include <memory>

#include "sim/core/hash.h"
#include "sim/gl/headless_context.h"
#include "sim/gl/simulator.h"
#include "sim/gl/upload.h"
#include "sim/gl/wein_simulator.h"
#include "tools/bench_commands.h"
#include "tools/bench_statistics.h"

namespace insonate::bench {
namespace {

constexpr std::size_t kImages = 256;  // of a frame, in one call or in so many

// What registration asks for around a pose: as many of them, each by a fraction of a millimetre elsewhere.
std::vector<Pose> poses_around(const Pose& pose) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < kImages; ++i) poses.push_back(wandering(pose, 7 * int(i)));
  return poses;
}

Image<float> random_picture(int width, int height) {
  Image<float> picture(width, height);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = unit_float(hash(std::uint32_t(i)));
  return picture;
}

}  // namespace

Table measure_batch(const Request& request) {
  const std::vector<Configuration> sizes = configurations(request, {{128, 96, 128, 96}, {64, 64, 64, 64}});
  Table table{{"device", "case", "view", "lines", "samples", "width", "height", "method", "images_a_call", "frames",
               "q1_ms", "median_ms", "q3_ms", "images_a_second"},
              {}};

  const gl::HeadlessContext context;
  tell_device();
  for_each_scene(request, [&](const Scene& scene) {
    gl::Simulator trainer;
    gl::upload_ct(scene.file, scene.volume.grid, [&] { trainer.set_volume(scene.volume, scene.table); });
    std::printf("\n%s, view %s, ms an image of %zu\n", scene.name.c_str(), scene.view.c_str(), kImages);
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
      gl::upload_ct(scene.file, scene.volume.grid, [&] {
        wein = std::make_unique<gl::WeinSimulator>(scene.volume, probe, scene.depth_mm, registering);
      });
      wein->set_ultrasound(random_picture(c.width, c.height));

      // One a call ends with the device's work, as a search that looks at each image before it asks for the next.
      const auto each = [](auto&& image_of) {
        return [=](const Pose& pose) {
          for (const Pose& at : poses_around(pose)) {
            image_of(at);
            glFinish();
          }
        };
      };
      const auto times =
          times_in_turn(scene.pose, request.frames,
                        {each([&](const Pose& pose) {
                           wein->simulate({&pose, 1});
                         }),
                         [&](const Pose& pose) { wein->simulate(poses_around(pose)); }, each([&](const Pose& pose) {
                           wein->similarity({&pose, 1});
                         }),
                         [&](const Pose& pose) { wein->similarity(poses_around(pose)); }, each([&](const Pose& pose) {
                           trainer.set_pose(pose);
                           trainer.image();
                         })});
      std::vector<Spread> ms;
      for (std::vector<double> of_method : times) {
        for (double& time : of_method) time /= double(kImages);
        ms.push_back(spread_of(of_method));
      }
      const auto add = [&](const char* method, std::size_t images_a_call, const Spread& spread) {
        table.rows.push_back({gl::device_description(), scene.name, scene.view, std::to_string(c.lines),
                              std::to_string(c.samples), std::to_string(c.width), std::to_string(c.height), method,
                              std::to_string(images_a_call), std::to_string(request.frames),
                              cell_of(spread.first_quartile, 5), cell_of(spread.median, 5),
                              cell_of(spread.third_quartile, 5), cell_of(1000 / spread.median, 1)});
      };
      const auto tell = [&](const char* method, const Spread& one, const Spread& all) {
        std::printf("%4d x %-4d      %4d x %-4d  %-10s  %.4f (%.4f to %.4f)  %.4f (%.4f to %.4f)  %5.2f\n", c.lines,
                    c.samples, c.width, c.height, method, one.median, one.first_quartile, one.third_quartile,
                    all.median, all.first_quartile, all.third_quartile, one.median / all.median);
      };
      tell("images", ms[0], ms[1]);
      tell("LC2", ms[2], ms[3]);
      tell("model S", ms[4], ms[1]);
      add("images", 1, ms[0]);
      add("images", kImages, ms[1]);
      add("LC2", 1, ms[2]);
      add("LC2", kImages, ms[3]);
      add("model S", 1, ms[4]);
    }
  });
  return table;
}

}  // namespace insonate::bench
