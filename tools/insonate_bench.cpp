// insonate-bench: what a frame costs on this machine, as medians with their spread.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/gl/headless_context.h"
#include "sim/gl/simulator.h"
#include "sim/gl/upload.h"
#include "tools/program.h"
#include "tools/subject.h"

using namespace insonate;

namespace {

struct Configuration {
  int lines, samples, width, height;
};

// The trainer's own picture, then the configurations of Kutter, Shams, Navab 2009.
constexpr Configuration kConfigurations[] = {{192, 512, 512, 512}, {256, 256, 256, 256}, {512, 512, 512, 512},
                                             {512, 512, 640, 480}, {512, 512, 800, 600}, {1024, 1024, 1024, 1024}};

struct Spread {
  double first_quartile, median, third_quartile;
};

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) { return values[std::size_t(share * double(values.size() - 1) + 0.5)]; };
  return {at(0.25), at(0.5), at(0.75)};
}

/// A frame with the probe a little further along each time, from setting the pose until the device has finished.
std::vector<double> moving_frames_ms(gl::Simulator& simulator, const Pose& start, int frames) {
  std::vector<double> times;
  for (int i = -3; i < frames; ++i) {  // three to warm up
    Pose pose = start;
    pose.translation += pose.direction({0.3 * std::sin(0.2 * i), 0, 0.3 * i});
    const auto begin = std::chrono::steady_clock::now();
    simulator.set_pose(pose);
    simulator.image();
    glFinish();
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    if (i >= 0) times.push_back(taken.count());
  }
  return times;
}

long runs_in_all(const gl::Simulator& simulator) {
  return std::accumulate(simulator.runs().begin(), simulator.runs().end(), 0L);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments("Measures what a frame of model S costs on this machine.", "insonate-bench");
  std::string subject_path, csv;
  int frames = 30;
  arguments.add_option("--case,--ct", subject_path, "A case folder, CT file or DICOM folder (the built-in abdomen)");
  arguments.add_option("--frames", frames, "Frames a configuration")
      ->check(CLI::Range(3, 100000))
      ->capture_default_str();
  arguments.add_option("--csv", csv, "Write the table as CSV too");

  return run_program(arguments, argc, argv, [&] {
    const Case subject = open_subject(subject_path);
    if (subject.views.empty())
      throw InputError(subject_path, "", "no view is marked and no body was found", "name a case with a view");
    const ReferenceView& view = subject.views.front();
    const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");

    const gl::HeadlessContext context;
    gl::Simulator simulator;
    gl::upload_ct(subject_path, subject.ct.grid, [&] {
      simulator.set_volume(make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table), table);
    });
    const Probe* known = find_probe(view.probe);
    if (!known)
      throw InputError(subject_path, "view '" + view.name + "'", "there is no probe named '" + view.probe + "'",
                       "name curvilinear or linear");
    Probe probe = *known;

    std::string rows = "device,case,view,lines,samples,width,height,frames,q1_ms,median_ms,q3_ms,runs_still\n";
    std::printf("%s\n%s, view %s, moving probe\n\n", gl::device_description().c_str(), subject.name.c_str(),
                view.name.c_str());
    std::printf("lines x samples  picture      median ms  (quartiles)       stages run by a still frame\n");
    for (const Configuration& c : kConfigurations) {
      probe.lines = c.lines;
      Settings settings = trainer_settings(probe.frequency_mhz, view.depth_mm);
      settings.samples = c.samples;
      settings.image_width = c.width;
      settings.image_height = c.height;
      simulator.set_probe(probe, view.depth_mm);
      simulator.set_settings(settings);
      const Spread ms = spread_of(moving_frames_ms(simulator, view.patient_from_probe, frames));
      const long before = runs_in_all(simulator);
      simulator.image();
      const long still = runs_in_all(simulator) - before;
      std::printf("%4d x %-4d      %4d x %-4d  %8.2f   (%.2f to %.2f)   %ld\n", c.lines, c.samples, c.width, c.height,
                  ms.median, ms.first_quartile, ms.third_quartile, still);
      char row[400];
      std::snprintf(row, sizeof row, "\"%s\",\"%s\",%s,%d,%d,%d,%d,%d,%.3f,%.3f,%.3f,%ld\n",
                    gl::device_description().c_str(), subject.name.c_str(), view.name.c_str(), c.lines, c.samples,
                    c.width, c.height, frames, ms.first_quartile, ms.median, ms.third_quartile, still);
      rows += row;
    }
    if (!csv.empty()) write_file(csv, rows);
    return 0;
  });
}
