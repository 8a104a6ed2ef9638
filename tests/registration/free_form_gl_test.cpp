// Tests deformations that are fitted to synthetic sweeps, which model S makes of a body that breathes.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim/core/hash.h"
#include "sim/registration/free_form.h"
#include "sim/registration/synthetic_sweep.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_body.h"

using namespace insonate;

namespace {

constexpr double kDepth_mm = 100;

struct Fixture {
  test::TestContext context;
  AcousticVolume body = test::test_body();
  std::function<glm::dvec3(const glm::dvec3&)> truth = breath({0, 55, 0}, 5);
  FreeFormSettings settings;

  Fixture() {
    settings.wein.samples = 64;
    settings.rounds = 4;
  }
  TrackedSweep sweep(const AcousticVolume& of) const {
    Probe probe = *find_probe("curvilinear");
    probe.lines = 96;
    return synthetic_sweep(of, test::tissues(), probe, kDepth_mm, trainer_settings(probe.frequency_mhz, kDepth_mm),
                           hand_sweep(test::on_the_skin(0, 6, 0), 16, 14, 16), 96, 72);
  }
  /// Returns the root mean square distance of a field's map from the truth.
  double error(const FreeFormField& field, const TrackedSweep& of) const {
    double squares = 0, count = 0;
    for (const glm::dvec3& p : target_points(of)) {
      const glm::dvec3 apart = field.at(p) - truth(p);
      squares += glm::dot(apart, apart);
      ++count;
    }
    return std::sqrt(squares / count);
  }
};

}  // namespace

TEST_CASE("a sweep of a body that breathes is matched by a deformation") {
  Fixture f;
  const TrackedSweep sweep = f.sweep(deformed(f.body, f.truth));
  int calls = 0;
  f.settings.between_calls = [&] { ++calls; };
  const FreeFormRegistration found = fit_free_form(f.body, sweep, glm::dmat4(1.0), f.settings);
  const double before = f.error(FreeFormField{}, sweep), after = f.error(found.field, sweep);
  INFO("error " << before << " to " << after << " mm, most " << found.most_mm << " mm, " << found.rounds << " rounds");
  INFO("fitted " << found.fitted_before << " to " << found.fitted_after << ", held out " << found.held_out_before
                 << " to " << found.held_out_after << " +- " << found.held_out_error);
  CHECK(found.is_improved());
  CHECK(before > 2);
  CHECK(after < 1.3);  // voxels are 1.3 to 2.1 mm large
  CHECK(found.most_mm > 3);
  CHECK(found.most_mm < 7);
  CHECK(found.fitted_after > found.fitted_before);
  CHECK(found.held_out_after > found.held_out_before);
  CHECK(found.held_out_error > 0);
  CHECK(found.least_jacobian >= f.settings.least_jacobian);
  CHECK(found.least_jacobian == found.field.least_jacobian());
  CHECK(calls > 0);
  // The first evaluation is that of no deformation; the best step is the result.
  CHECK(found.evaluations.front().similarity == Approx(found.fitted_before));
  CHECK(found.evaluations.front().bending_energy_mm2 == 0);
  CHECK(std::ranges::any_of(found.evaluations, [&](const FreeFormEvaluation& each) {
    return !each.varied && each.similarity == found.fitted_after &&
           each.bending_energy_mm2 == Approx(found.field.bending_energy());
  }));
}

TEST_CASE("a body that does not deform is left nearly as it is") {
  Fixture f;
  const TrackedSweep sweep = f.sweep(f.body);
  const FreeFormRegistration found = fit_free_form(f.body, sweep, glm::dmat4(1.0), f.settings);
  f.truth = [](const glm::dvec3& p) { return p; };
  INFO("held out " << found.held_out_before << " to " << found.held_out_after << " +- " << found.held_out_error);
  CHECK(f.error(found.field, sweep) < 1);
}

TEST_CASE("a deformation presses tissue no further than it may") {
  Fixture f;
  f.settings.least_jacobian = 0.96;  // without the limit it is 0.92 and less
  f.settings.rounds = 2;
  const FreeFormRegistration found =
      fit_free_form(f.body, f.sweep(deformed(f.body, f.truth)), glm::dmat4(1.0), f.settings);
  CHECK(found.is_improved());
  CHECK(found.least_jacobian >= 0.96);
  CHECK(found.least_jacobian < 0.99);
}

TEST_CASE("images of noise are not improved by a deformation") {
  Fixture f;
  TrackedSweep noise = f.sweep(f.body);
  std::uint32_t next = 0;
  for (SweepImage& image : noise.images)
    for (float& pixel : image.grey.pixels)
      if (!std::isnan(pixel)) pixel = 255 * unit_float(hash(next++));
  f.settings.smoothness_mm2 = 0;
  f.settings.spacing_mm = 12;
  f.settings.rounds = 3;
  const FreeFormRegistration found = fit_free_form(f.body, noise, glm::dmat4(1.0), f.settings);
  INFO("held out " << found.held_out_before << " to " << found.held_out_after << " +- " << found.held_out_error);
  CHECK(found.fitted_after > found.fitted_before);  // it fits noise
  CHECK_FALSE(found.is_improved());
  CHECK(found.field.bending_energy() == 0);
}

TEST_CASE("a deformation needs patches, images to judge it by, and a bounded number of control points") {
  Fixture f;
  TrackedSweep sweep = f.sweep(f.body);
  sweep.images.resize(3);
  CHECK_THROWS_AS(fit_free_form(f.body, sweep, glm::dmat4(1.0), f.settings), std::invalid_argument);
  sweep.images.push_back(sweep.images.front());
  FreeFormSettings dense = f.settings;
  dense.spacing_mm = 2;
  CHECK_THROWS_AS(fit_free_form(f.body, sweep, glm::dmat4(1.0), dense), std::invalid_argument);
  f.settings.wein.similarity_patch = 0;
  CHECK_THROWS_AS(fit_free_form(f.body, sweep, glm::dmat4(1.0), f.settings), std::invalid_argument);
}
