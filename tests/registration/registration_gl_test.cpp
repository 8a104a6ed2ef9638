// Tests whole registrations of synthetic sweeps, which model S makes.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/core/hash.h"
#include "sim/registration/registration.h"
#include "sim/registration/synthetic_sweep.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_body.h"

using namespace insonate;

namespace {

constexpr double kDepth_mm = 100;

struct Fixture {
  test::TestContext context;
  AcousticVolume body = test::test_body();
  TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Probe probe = *find_probe("curvilinear");
  TrackedSweep sweep = synthetic_sweep(body, table, probe, kDepth_mm, trainer_settings(probe.frequency_mhz, kDepth_mm),
                                       hand_sweep(test::on_the_skin(0, 6, 0), 8, 12, 16), 96, 72);
  std::vector<glm::dvec3> targets = target_points(sweep);
  RegistrationSettings settings;

  Fixture() {
    settings.search_mm = 12;
    settings.search_deg = 12;
    settings.scattered = 300;
    settings.followed = 6;
    settings.wide_slices = 8;
  }
  glm::dmat4 start(const glm::dvec3& shift_mm, double turn_deg) const {
    const glm::dvec3 middle = motion_about(targets, glm::dmat4(1.0)).centre_in_ct;
    return glm::translate(glm::dmat4(1.0), middle + shift_mm) *
           glm::rotate(glm::dmat4(1.0), glm::radians(turn_deg), glm::normalize(glm::dvec3(1, 2, -1))) *
           glm::translate(glm::dmat4(1.0), -middle);
  }
  double error(const SweepRegistration& found) const {
    return target_error_mm(targets, found.ct_from_sweep, glm::dmat4(1.0));
  }
};

}  // namespace

TEST_CASE("a synthetic sweep of model S is registered with the body that it shows, and the result is sure of it") {
  const Fixture f;
  const glm::dmat4 start = f.start({4, -3, 3}, 6);
  const SweepRegistration found = SweepRegistrar(f.body, f.sweep, f.settings).from(start);
  INFO("doubts: " << (found.doubts.empty() ? std::string("none") : found.doubts.front()));
  INFO("similarity " << found.similarity_before << " to " << found.similarity_after << ", next " << found.runner_up);
  CHECK(target_error_mm(f.targets, start, glm::dmat4(1.0)) > 5);
  // Voxels are 1.3 to 2.1 mm large.
  CHECK(f.error(found) < 2);
  CHECK(found.converged());
  CHECK(found.similarity_after > found.similarity_before);
  CHECK(found.deviation.size() == 6);
  CHECK(found.expected_error_mm > 0);
  CHECK(found.expected_error_mm < 2);
  for (const Evaluation& each : found.evaluations) CHECK(each.at.size() == 6);
  CHECK(std::ranges::max(found.evaluations, {}, [](const Evaluation& e) {
          return e.stage == 2 ? e.similarity : 0;
        }).similarity >= Approx(found.similarity_after).margin(1e-6));
}

// Voxels of 0.65 to 1.05 mm are joined for the widest stage; those of the body above are not.
TEST_CASE("a sweep is registered with a CT whose voxels are joined for the widest stage") {
  const Fixture f;
  AcousticVolume fine;
  fine.grid = f.body.grid;
  fine.grid.size = f.body.grid.size * 2;
  fine.grid.spacing = f.body.grid.spacing / 2.0;
  fine.grid.origin = f.body.grid.patient_from_index(glm::dvec3(-0.25));
  for (int k = 0; k < fine.grid.size.z; ++k)
    for (int j = 0; j < fine.grid.size.y; ++j)
      for (int i = 0; i < fine.grid.size.x; ++i) fine.voxels.push_back(f.body.at({i / 2, j / 2, k / 2}));
  const SweepRegistration found = SweepRegistrar(fine, f.sweep, f.settings).from(f.start({4, -3, 3}, 6));
  INFO("doubts: " << (found.doubts.empty() ? std::string("none") : found.doubts.front()));
  CHECK(f.error(found) < 2);  // as above
  CHECK(found.converged());
}

// The similarity is uneven: local searches alone end up to 1.6 % below the highest place around.
TEST_CASE("registrations from several starts end about equally high") {
  const Fixture f;
  SweepRegistrar registrar(f.body, f.sweep, f.settings);
  double lowest = 1, highest = 0;
  for (const int i : {4, 5, 8, 10}) {
    const auto random = [&](int k) { return 2 * unit_float(hash(std::uint32_t(10 * i + k))) - 1; };
    const SweepRegistration found =
        registrar.from(f.start(8.0 * glm::dvec3(random(0), random(1), random(2)), 8 * random(3)));
    lowest = std::min(lowest, found.similarity_after);
    highest = std::max(highest, found.similarity_after);
    CHECK(f.error(found) < 2);
  }
  CHECK(lowest > 0.99 * highest);
}

TEST_CASE("a narrow search around a place that is right does not doubt it for what lies beside it") {
  Fixture f;
  f.settings.search_mm = f.settings.search_deg = 2;
  for (const double off_mm : {0.5, 1.5, 2.5}) {
    const SweepRegistration found = SweepRegistrar(f.body, f.sweep, f.settings).from(f.start({off_mm, 0, -off_mm}, 1));
    INFO("next " << found.runner_up << (found.doubts.empty() ? "" : found.doubts.front()));
    CHECK(found.converged());
    CHECK(f.error(found) < 2);
  }
}

TEST_CASE("equal registrations give equal results") {
  Fixture f;
  f.settings.freedom = Freedom::affine;  // which begins with a rigid one
  const SweepRegistration one = SweepRegistrar(f.body, f.sweep, f.settings).from(f.start({2, 0, 1}, 3)),
                          other = SweepRegistrar(f.body, f.sweep, f.settings).from(f.start({2, 0, 1}, 3));
  CHECK(one.at == other.at);
  CHECK(one.evaluations.size() == other.evaluations.size());
  CHECK(one.doubts == other.doubts);
  CHECK(one.runner_up == other.runner_up);
  CHECK(one.elsewhere == other.elsewhere);
}

TEST_CASE("an affine registration finds a stretch that a rigid one cannot") {
  const Fixture f;
  TrackedSweep stretched = f.sweep;
  // The tracker reports 8 % less along the sweep than the hand moved. The truth is then a stretch along z.
  const glm::dvec3 middle = motion_about(f.targets, glm::dmat4(1.0)).centre_in_ct;
  for (SweepImage& image : stretched.images)
    image.sweep_from_probe.translation.z = middle.z + (image.sweep_from_probe.translation.z - middle.z) / 1.08;
  RegistrationSettings affine = f.settings;
  affine.freedom = Freedom::affine;
  affine.search_mm = affine.search_deg = 0;
  RegistrationSettings rigid = affine;
  rigid.freedom = Freedom::rigid;
  const SweepRegistration with = SweepRegistrar(f.body, stretched, affine).from(glm::dmat4(1.0)),
                          without = SweepRegistrar(f.body, stretched, rigid).from(glm::dmat4(1.0));
  CHECK(with.at.size() == 12);
  CHECK(with.similarity_after > without.similarity_after);
}

TEST_CASE("images that lie close together do not converge, even at the right place") {
  Fixture f;
  f.settings.search_mm = f.settings.search_deg = 3;
  TrackedSweep narrow = f.sweep;
  narrow.images.resize(4);
  CHECK(spread_mm(f.sweep) > kMinSpread_mm);
  CHECK(spread_mm(narrow) < kMinSpread_mm);
  CHECK(SweepRegistrar(f.body, f.sweep, f.settings).from(glm::dmat4(1.0)).converged());
  const SweepRegistration found = SweepRegistrar(f.body, narrow, f.settings).from(glm::dmat4(1.0));
  CHECK(std::ranges::count(found.doubts, "the images lie too close together to tell one place from another") == 1);
}

TEST_CASE("seven images do not converge, even at the right place and far apart") {
  Fixture f;
  f.settings.search_mm = f.settings.search_deg = 3;
  TrackedSweep few = f.sweep;
  few.images.erase(few.images.begin() + 3);
  REQUIRE(few.images.size() + 1 == kMinImages);
  REQUIRE(spread_mm(few) > kMinSpread_mm);
  const SweepRegistration found = SweepRegistrar(f.body, few, f.settings).from(glm::dmat4(1.0));
  CHECK(f.error(found) < 2);
  CHECK(found.doubts == std::vector<std::string>{kTooFew});
}

TEST_CASE("a registration that has not looked for other places does not converge, even at the right one") {
  Fixture f;
  f.settings.search_mm = f.settings.search_deg = 0;
  const SweepRegistration found = SweepRegistrar(f.body, f.sweep, f.settings).from(glm::dmat4(1.0));
  CHECK(found.doubts == std::vector<std::string>{kNotSearched});
}

TEST_CASE("images of noise do not converge, however far is searched") {
  const Fixture f;
  TrackedSweep noise = f.sweep;
  std::uint32_t next = 0;
  for (SweepImage& image : noise.images)
    for (float& pixel : image.grey.pixels)
      if (!std::isnan(pixel)) pixel = 255 * unit_float(hash(next++));
  for (const double range : {12.0, 3.0, 0.0}) {
    RegistrationSettings settings = f.settings;
    settings.search_mm = settings.search_deg = range;
    const SweepRegistration found = SweepRegistrar(f.body, noise, settings).from(glm::dmat4(1.0));
    INFO(range << " mm: similarity " << found.similarity_after << ", next " << found.runner_up << ", elsewhere "
               << found.elsewhere);
    CHECK_FALSE(found.converged());
    CHECK(std::ranges::count(found.doubts, "places far away are nearly as similar") == 1);
  }
}
