#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "sim/gl/headless_context.h"
#include "sim/imaging/upload.h"
#include "sim/model/settings.h"
#include "sim/registration/free_form.h"
#include "sim/registration/registration.h"
#include "sim/registration/synthetic_sweep.h"
#include "tools/bench/commands.h"

namespace insonate::bench {
namespace {

constexpr int kWidth = 128, kHeight = 96;  // pixels of the sweep's images

}  // namespace

Table measure_deformation(const Request& request, const DeformationRequest& wanted) {
  Table table{{"device", "case", "view", "breath_mm", "rigid_error_mm", "affine_error_mm", "free_form_error_mm",
               "affine_converged", "improved", "held_out_before", "held_out_after", "held_out_error", "least_jacobian",
               "spacing_mm", "smoothness_mm2", "rounds", "evaluations", "seconds"},
              {}};
  const gl::HeadlessContext context;
  tell_device();
  for_each_scene(request, [&](const Scene& scene) {
    const std::vector<Pose> poses = hand_sweep(scene.pose, wanted.images, wanted.tilt_deg, wanted.slide_mm);
    std::printf("\n%s, view %s\nbreath      rigid     affine    free-form  improved  held out            Jacobian\n",
                scene.name.c_str(), scene.view.c_str());
    for (const double breath_mm : wanted.breaths_mm) {
      // The organs lie about two fifths of the way down.
      const auto truth = breath(scene.pose.point(glm::dvec3(0, 0.4 * scene.depth_mm, 0)), breath_mm);
      const TrackedSweep sweep =
          synthetic_sweep(deformed(scene.volume, truth), scene.table, scene.probe, scene.depth_mm,
                          trainer_settings(scene.probe.frequency_mhz, scene.depth_mm), poses, kWidth, kHeight);
      const std::vector<glm::dvec3> targets = target_points(sweep);
      const auto error = [&](const glm::dmat4& map, const FreeFormField& field) {
        double squares = 0;
        for (const glm::dvec3& p : targets) {
          const glm::dvec3 apart = glm::dvec3(map * glm::dvec4(field.at(p), 1)) - truth(p);
          squares += glm::dot(apart, apart);
        }
        return std::sqrt(squares / double(targets.size()));
      };
      RegistrationSettings settings;
      settings.search_mm = settings.search_deg = 0;
      const SweepRegistration rigid = SweepRegistrar(scene.volume, sweep, settings).from(glm::dmat4(1.0));
      settings.freedom = Freedom::affine;
      const SweepRegistration affine = SweepRegistrar(scene.volume, sweep, settings).from(glm::dmat4(1.0));
      const FreeFormRegistration found = fit_free_form(scene.volume, sweep, affine.ct_from_sweep, wanted.settings);
      const double errors[] = {error(rigid.ct_from_sweep, {}), error(affine.ct_from_sweep, {}),
                               error(affine.ct_from_sweep, found.field)};
      std::printf("%4.1f mm  %6.2f mm  %6.2f mm  %6.2f mm  %-8s  %.4f to %.4f  %.2f  %.1f s\n", breath_mm, errors[0],
                  errors[1], errors[2], found.is_improved() ? "yes" : "no", found.held_out_before, found.held_out_after,
                  found.least_jacobian, found.seconds);
      std::fflush(stdout);
      table.rows.push_back(
          {gl::device_description(), scene.name, scene.view, cell_of(breath_mm, 1), cell_of(errors[0], 3),
           cell_of(errors[1], 3), cell_of(errors[2], 3), affine.converged() ? "1" : "0",
           found.is_improved() ? "1" : "0", cell_of(found.held_out_before, 5), cell_of(found.held_out_after, 5),
           cell_of(found.held_out_error, 5), cell_of(found.least_jacobian, 3), cell_of(wanted.settings.spacing_mm, 1),
           cell_of(wanted.settings.smoothness_mm2, 1), std::to_string(found.rounds),
           std::to_string(found.evaluations.size()), cell_of(found.seconds, 3)});
    }
  });
  return table;
}

}  // namespace insonate::bench
