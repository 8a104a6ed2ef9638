#include "tools/bench/scene.h"

#include <epoxy/gl.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/files/files.h"
#include "sim/gl/headless_context.h"
#include "sim/model/settings_file.h"
#include "tools/cli/subject.h"

namespace insonate::bench {
namespace {

constexpr int kWarmUpFrames = 3;

const ReferenceView& chosen_view(const Case& subject, const std::string& file, const std::string& name) {
  if (subject.views.empty())
    throw InputError(file, "", "no view is marked and no body was found", "name a case with a view");
  if (name.empty()) return subject.views.front();
  if (const ReferenceView* view = subject.find_view(name)) return *view;
  std::vector<std::string> names;
  for (const ReferenceView& view : subject.views) names.push_back(view.name);
  throw InputError(file, "", "there is no view named '" + name + "'", suggest(name, names));
}

Scene open_scene(const std::string& file, const std::string& view_name, bool structure, const TissueTable& table) {
  const Case subject = open_subject(file);
  const ReferenceView& view = chosen_view(subject, file, view_name);
  const Probe* probe = find_probe(view.probe);
  if (!probe)
    throw InputError(file, "view '" + view.name + "'", "there is no probe named '" + view.probe + "'",
                     "name curvilinear or linear");
  return {file,          subject.name,
          view.name,     make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table, structure),
          table,         *probe,
          view.depth_mm, view.patient_from_probe};
}

}  // namespace

const std::vector<Configuration> kPaperConfigurations = {
    {256, 256, 256, 256}, {512, 512, 512, 512}, {512, 512, 640, 480}, {512, 512, 800, 600}, {1024, 1024, 1024, 1024}};

void for_each_scene(const Request& request, const std::function<void(const Scene&)>& measure) {
  const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
  if (request.built_in || request.subjects.empty()) measure(open_scene("", request.view, request.structure, table));
  for (const std::string& file : request.subjects) measure(open_scene(file, request.view, request.structure, table));
}

std::vector<Configuration> configurations(const Request& request, const std::vector<Configuration>& usual) {
  const std::vector<int>& numbers = request.configurations;
  if (numbers.empty()) return usual;
  if (numbers.size() % 4 != 0)
    throw InputError("--configuration", "", std::to_string(numbers.size()) + " numbers are not whole configurations",
                     "give LINES,SAMPLES,WIDTH,HEIGHT");
  std::vector<Configuration> given;
  for (std::size_t i = 0; i < numbers.size(); i += 4) {
    constexpr int kMax[] = {4096, 8192, 8192, 8192};
    for (std::size_t j = 0; j < 4; ++j)
      if (numbers[i + j] < 1 || numbers[i + j] > kMax[j])
        throw InputError("--configuration", "number " + std::to_string(i + j + 1),
                         std::to_string(numbers[i + j]) + " lies outside 1 to " + std::to_string(kMax[j]),
                         "give LINES,SAMPLES,WIDTH,HEIGHT");
    given.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]});
  }
  return given;
}

void tell_device() {
  std::printf("%s%s\n", gl::device_description().c_str(),
              gl::is_software_renderer()
                  ? ": a SOFTWARE RENDERER, so the times are the processor's and no graphics card's"
                  : "");
}

Settings settings_of(const Scene& scene, const Configuration& c, bool trainer) {
  Settings settings =
      trainer ? trainer_settings(scene.probe.frequency_mhz, scene.depth_mm) : paper_settings(scene.depth_mm, c.samples);
  settings.samples = c.samples;
  if (trainer) settings.reflection_length_mm = 2 * scene.depth_mm / c.samples;
  settings.image_width = c.width;
  settings.image_height = c.height;
  if (const auto why = why_not_valid(settings))
    throw InputError("--configuration", std::to_string(c.samples) + " samples", *why,
                     "it is that of one or two samples: give another number of them");
  return settings;
}

Pose wandering(const Pose& start, int frame) {
  Pose pose = start;
  pose.translation += pose.direction({3 * std::sin(0.2 * frame), 0, 5 * std::sin(0.06 * frame)});
  return pose;
}

std::vector<Pose> poses_around(const Pose& pose, std::size_t images) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < images; ++i) poses.push_back(wandering(pose, 7 * int(i)));
  return poses;
}

std::vector<std::vector<double>> alternating_times(const Pose& start, int frames,
                                                   const std::vector<std::function<void(const Pose&)>>& methods,
                                                   int first) {
  std::vector<std::vector<double>> times(methods.size());
  for (int frame = first - kWarmUpFrames; frame < first + frames; ++frame) {
    const Pose pose = wandering(start, frame);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const auto begin = std::chrono::steady_clock::now();
      methods[i](pose);
      glFinish();
      const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
      if (frame >= first) times[i].push_back(taken.count());
    }
  }
  return times;
}

}  // namespace insonate::bench
