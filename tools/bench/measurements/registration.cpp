#include "sim/registration/registration.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "sim/core/hash.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/upload.h"
#include "sim/model/settings.h"
#include "sim/registration/synthetic_sweep.h"
#include "tools/bench/commands.h"

namespace insonate::bench {
namespace {

constexpr std::string_view kLocal = "-local";  // behind a measure's name: searches from the start alone

// Numbers from 0 to 1 that depend on the start alone, so that every measure gets the same starts.
double random_number(int start, int which) {
  return unit_float(hash(std::uint32_t(start), std::uint32_t(which)));
}

glm::dvec3 random_direction(int start, int which) {
  const double z = 2 * random_number(start, which) - 1, turn = glm::radians(360 * random_number(start, which + 1)),
               r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

struct Start {
  double mm = 0, deg = 0;
  glm::dmat4 ct_from_sweep{1.0};
};

// Every second start is a near one.
constexpr double kFar_mm = 40, kFar_deg = 40, kNear_mm = 20, kNear_deg = 15;

// Returns a start that is off by a translation and by a rotation about the middle of the sweep.
Start start_at(int number, const glm::dvec3& middle) {
  const double most_mm = number % 2 ? kNear_mm : kFar_mm, most_deg = number % 2 ? kNear_deg : kFar_deg;
  Start start;
  start.mm = most_mm * random_number(number, 0);
  start.deg = most_deg * random_number(number, 1);
  const glm::dvec3 shift = start.mm * random_direction(number, 2), axis = random_direction(number, 4);
  start.ct_from_sweep = glm::translate(glm::dmat4(1.0), middle + shift) *
                        glm::rotate(glm::dmat4(1.0), glm::radians(start.deg), axis) *
                        glm::translate(glm::dmat4(1.0), -middle);
  return start;
}

}  // namespace

Table measure_registration(const Request& request, const RegistrationRequest& wanted) {
  Table table{{"device", "case", "view", "measure", "start", "start_mm", "start_deg", "start_error_mm", "error_mm",
               "expected_mm", "converged", "similarity", "runner_up", "evaluations", "seconds", "seconds_to_prepare"},
              {}};
  const gl::HeadlessContext context;
  tell_device();
  for_each_scene(request, [&](const Scene& scene) {
    const std::vector<Pose> poses = hand_sweep(scene.pose, wanted.images, wanted.tilt_deg, wanted.slide_mm);
    const TrackedSweep sweep =
        synthetic_sweep(scene.volume, scene.table, scene.probe, scene.depth_mm,
                        trainer_settings(scene.probe.frequency_mhz, scene.depth_mm), poses, 128, 96);
    const std::vector<glm::dvec3> targets = target_points(sweep);
    std::printf("\n%s, view %s: %d images of %d degrees and %d mm\n", scene.name.c_str(), scene.view.c_str(),
                wanted.images, int(2 * wanted.tilt_deg), int(wanted.slide_mm));
    std::printf(
        "measure      start                      error      expected  verdict  similarity  next    evaluations\n");
    const glm::dvec3 middle = motion_about(targets, glm::dmat4(1.0)).centre_in_ct;
    for (const std::string& name : wanted.measures) {
      RegistrationSettings settings = wanted.settings;
      const bool local = name.ends_with(kLocal);
      settings.measure = measure_named(name.substr(0, name.size() - (local ? kLocal.size() : 0)));
      if (local) settings.search_mm = settings.search_deg = 0;
      SweepRegistrar registrar(scene.volume, sweep, settings);
      for (int i = 0; i < wanted.starts; ++i) {
        const Start start = start_at(wanted.first_start + i, middle);
        const SweepRegistration found = registrar.from(start.ct_from_sweep);
        const double error = target_error_mm(targets, found.ct_from_sweep, glm::dmat4(1.0));
        const double start_error = target_error_mm(targets, start.ct_from_sweep, glm::dmat4(1.0));
        std::printf("%-10s%5d  %5.1f mm  %5.1f deg  %8.2f mm  %8.2f mm  %-7s  %.4f      %.4f  %6zu  %6.1f s\n",
                    name.c_str(), wanted.first_start + i, start.mm, start.deg, error, found.expected_error_mm,
                    found.converged() ? "yes" : "no", found.similarity_after, found.runner_up, found.evaluations.size(),
                    found.seconds);
        std::fflush(stdout);
        table.rows.push_back({gl::device_description(), scene.name, scene.view, name,
                              std::to_string(wanted.first_start + i), cell_of(start.mm, 2), cell_of(start.deg, 2),
                              cell_of(start_error, 2), cell_of(error, 3), cell_of(found.expected_error_mm, 3),
                              found.converged() ? "1" : "0", cell_of(found.similarity_after, 5),
                              cell_of(found.runner_up, 5), std::to_string(found.evaluations.size()),
                              cell_of(found.seconds, 3), cell_of(registrar.seconds_to_prepare(), 3)});
      }
    }
  });
  return table;
}

}  // namespace insonate::bench
