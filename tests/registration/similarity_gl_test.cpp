// Tests the similarity of whole sweeps: LC2 of many images in one call, and the two baselines by hand.

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "sim/core/hash.h"
#include "sim/registration/similarity.h"
#include "sim/registration/synthetic_sweep.h"
#include "sim/wein/wein_simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_body.h"

using namespace insonate;

namespace {

constexpr double kDepth_mm = 90;

// Returns images of noise and a ramp, each different, with a part that is unknown in the second one alone.
TrackedSweep noisy_sweep(int images) {
  TrackedSweep sweep{Probe(*find_probe("curvilinear")), kDepth_mm, {}};
  sweep.probe.lines = 48;
  for (int i = 0; i < images; ++i) {
    SweepImage image{test::on_the_skin(3 * i - 4, 9, 4 * i), Image<float>(64, 48)};
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x)
        image.grey.at(x, y) =
            i == 1 && x > 40
                ? std::numeric_limits<float>::quiet_NaN()
                : float((i + 1) * (y + 30 * unit_float(hash(std::uint32_t(64 * y + x), std::uint32_t(i)))));
    sweep.images.push_back(std::move(image));
  }
  return sweep;
}

}  // namespace

TEST_CASE("LC2 of a sweep is the mean over its images, weighted by their variation, for every place of a call") {
  const test::TestContext context;
  const AcousticVolume body = test::test_body();
  for (const int patch : {0, 8}) {
    WeinSettings settings;
    settings.similarity_patch = patch;
    settings.image_width = 64;
    settings.image_height = 48;
    const TrackedSweep sweep = noisy_sweep(3);
    const auto similarity = lc2_similarity(body, sweep, settings);
    std::vector<glm::dmat4> places;
    for (int i = 0; i < 5; ++i) places.push_back(glm::translate(glm::dmat4(1.0), glm::dvec3(2 * i, i, -3 * i)));
    const std::vector<double> found = similarity->at(places);
    REQUIRE(found.size() == places.size());
    gl::WeinSimulator single(body, sweep.probe, kDepth_mm, settings);
    for (std::size_t p = 0; p < places.size(); ++p) {
      double sum = 0, weights = 0, of_second = 0;
      for (const SweepImage& image : sweep.images) {
        single.set_ultrasound(image.grey);
        const glm::dmat4 place = places[p] * image.sweep_from_probe.matrix();
        const double weight = single.ultrasound_variation().front();
        const double similar = single.similarity(std::span<const glm::dmat4>(&place, 1)).front();
        sum += weight * similar;
        weights += weight;
        if (&image == &sweep.images[1]) of_second = similar;
      }
      INFO("patch " << patch << ", place " << p);
      CHECK(found[p] > 0.01);
      // One image and many in a call differ by the rounding of single precision.
      CHECK(found[p] == Approx(sum / weights).margin(2e-5));
      CHECK(similarity->at({&places[p], 1}).front() == Approx(found[p]).margin(2e-5));
      CHECK(std::abs(of_second - found[p]) > 4e-5);  // twice the margin: neither passes for the other
      CHECK(similarity->at({&places[p], 1}, {1, 1}).front() == Approx(of_second).margin(2e-5));
      CHECK(similarity->at({&places[p], 1}, {0, 99}).front() == Approx(found[p]).margin(2e-5));
    }
  }
}

TEST_CASE("model W takes affine maps, and refuses those that are none") {
  const test::TestContext context;
  const AcousticVolume body = test::test_body();
  const TrackedSweep sweep = noisy_sweep(2);
  const auto similarity = lc2_similarity(body, sweep, WeinSettings{});
  const glm::dmat4 same(1.0), wider = glm::scale(glm::dmat4(1.0), glm::dvec3(1.1, 1, 1));
  CHECK(similarity->at({&same, 1}).front() != similarity->at({&wider, 1}).front());
  const glm::dmat4 flat = glm::scale(glm::dmat4(1.0), glm::dvec3(0.1, 1, 1));
  CHECK_THROWS_AS(similarity->at({&flat, 1}), std::invalid_argument);
  glm::dmat4 broken(1.0);
  broken[3].x = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(similarity->at({&broken, 1}), std::invalid_argument);
}

TEST_CASE("the baselines are perfect where the ultrasound is a function of the CT, and little where it is noise") {
  AcousticVolume volume;
  volume.grid.size = {64, 64, 64};
  volume.voxels.resize(volume.grid.count());
  for (int k = 0; k < 64; ++k)
    for (int j = 0; j < 64; ++j)
      for (int i = 0; i < 64; ++i) volume.voxels[volume.grid.offset({i, j, k})].hu = std::int16_t(j < 32 ? 0 : 100);
  TrackedSweep sweep{Probe(*find_probe("linear")), 40, {}};
  const ImageGeometry geometry = image_geometry(sweep.probe, 40, 64, 48);
  SweepImage image{Pose{glm::dmat3(1.0), glm::dvec3(31.5, 12, 31.5)}, Image<float>(64, 48)};
  // Falls where the density rises, with the border between two voxels, as the CT's own interpolation has it.
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      image.grey.at(x, y) = float(200 - std::min(std::max(geometry.plane_mm(x, y).y + 12 - 31, 0.0), 1.0) * 150);
  sweep.images.push_back(image);
  const std::vector<glm::dmat4> places{glm::dmat4(1.0), glm::translate(glm::dmat4(1.0), glm::dvec3(0, 10, 0)),
                                       glm::translate(glm::dmat4(1.0), glm::dvec3(5, 0, 0))};
  for (const Measure measure : {Measure::mutual_information, Measure::correlation_ratio}) {
    const std::vector<double> found = slice_similarity(measure, volume, sweep, WeinSettings{})->at(places);
    const double perfect = measure == Measure::mutual_information ? 2 : 1;
    INFO(to_string(measure));
    CHECK(found[0] == Approx(perfect).margin(0.05));  // a bin is wider than a step of the border
    CHECK(found[1] < found[0] - 0.2);
    CHECK(found[2] == Approx(found[0]).margin(1e-6));  // along the border nothing changes
    TrackedSweep noise = sweep;
    for (std::size_t i = 0; i < noise.images[0].grey.pixels.size(); ++i)
      noise.images[0].grey.pixels[i] = unit_float(hash(std::uint32_t(i)));
    const double none = measure == Measure::mutual_information ? 1 : 0;
    CHECK(slice_similarity(measure, volume, noise, WeinSettings{})->at(places).front() == Approx(none).margin(0.05));
    TrackedSweep both = sweep;
    both.images.push_back(noise.images[0]);
    const auto of_both = slice_similarity(measure, volume, both, WeinSettings{});
    CHECK(of_both->at(places, {0, 1}) == found);
    CHECK(of_both->at(places, {1, 1}).front() == Approx(none).margin(0.05));
    CHECK(of_both->at(places).front() < perfect - 0.2);
  }
}

TEST_CASE("each measure's name parses back to it") {
  for (const Measure measure : {Measure::lc2, Measure::mutual_information, Measure::correlation_ratio})
    CHECK(measure_named(to_string(measure)) == measure);
  CHECK_THROWS_AS(measure_named("ssd"), std::out_of_range);
}
