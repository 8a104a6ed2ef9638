// Tests model W and LC2 on the graphics card: against the double-precision reference, one image against many in a call,
// and the properties that registration relies on.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "sim/wein/wein_reference.h"
#include "sim/wein/wein_simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/test_body.h"
#include "tests/wein/wein_parity.h"

using namespace insonate;

namespace {

constexpr double kDepth_mm = 110;

Probe curvilinear() {
  Probe probe = *find_probe("curvilinear");
  probe.lines = 61;  // not a multiple of any width that a device works at
  return probe;
}

WeinSettings small() {
  WeinSettings settings;
  settings.samples = 91;  // odd, so that a line is not made of whole pairs
  settings.image_width = 70;
  settings.image_height = 50;
  return settings;
}

struct Fixture {
  test::TestContext context;
  AcousticVolume body = test::test_body();
  Probe probe = curvilinear();
  WeinSettings settings = small();
  Pose pose = test::on_the_skin(0, 9, 12);
  gl::WeinSimulator simulator{body, probe, kDepth_mm, test::exact_as_needed(settings)};

  WeinStages<double> expected(const Pose& at) const {
    return wein_reference(wein_field(body, settings.reflection_length_mm), probe, kDepth_mm, settings, at);
  }
  Image<float> ultrasound_like(const WeinStages<double>& stages, double gain, double offset, double noise) const {
    Image<float> image(settings.image_width, settings.image_height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] = float(offset + gain * (0.7 * stages.echogenicity.pixels[i] + stages.reflection.pixels[i] +
                                               noise * unit_float(hash(7, std::uint32_t(i)))));
    return image;
  }
  /// Returns the number of samples where the CT's outer voxels and the air around it still count.
  std::uint64_t samples_in_ct(const Pose& from) const {
    const ScanLines lines = scan_lines(probe, kDepth_mm, settings.samples);
    std::uint64_t count = 0;
    for (const ScanLine& line : lines.lines)
      for (int k = 0; k < lines.samples; ++k) {
        const glm::dvec3 at = from.point(line.start + (lines.r_min_mm + (k + 0.5) * lines.dr_mm()) * line.direction);
        const glm::dvec3 index = body.grid.index_from_patient(at);
        count += glm::all(glm::greaterThan(index, glm::dvec3(-1.5))) &&
                 glm::all(glm::lessThan(index, glm::dvec3(body.grid.size) + 0.5));
      }
    return count;
  }
  double similarity(const Image<float>& ultrasound, const Pose& at) {
    simulator.set_ultrasound(ultrasound);
    return simulator.similarity({&at, 1}).front();
  }
};

bool in_the_air(int i) {
  return i == 3 || i == 8;
}

// Returns poses that see different images, two of them only air. Their lines must end independently of other images'
// lines.
std::vector<Pose> poses(int count) {
  std::vector<Pose> all;
  for (int i = 0; i < count; ++i) {
    all.push_back(test::on_the_skin(-20 + 40.0 * i / count, 9, 12 - i % 7));
    if (in_the_air(i)) all.back().translation.y = -500;
  }
  return all;
}

void check_parity(const WeinSettings& settings, const Probe& probe, const Pose& pose) {
  const test::TestContext context;
  const AcousticVolume body = test::test_body();
  gl::WeinSimulator simulator(body, probe, kDepth_mm, test::exact_as_needed(settings));
  const WeinStages<float> got = simulator.read_stages(pose);
  const WeinField field = wein_field(body, settings.reflection_length_mm);
  test::check_wein_stages(test::reference_wein_stages(field, probe, kDepth_mm, settings, pose), got);
  for (std::size_t i = 0; i < got.grey.pixels.size(); ++i)
    if (!simulator.inside().pixels[i]) CHECK(got.grey.pixels[i] == 0);
}

}  // namespace

TEST_CASE("model W: GLSL agrees with the reference") {
  check_parity(small(), curvilinear(), test::on_the_skin(0, 9, 12));
  WeinSettings exact = small();
  exact.exact_filter = true;
  check_parity(exact, curvilinear(), test::on_the_skin(0, 9, 12));
  Probe linear = *find_probe("linear");
  linear.lines = 40;
  WeinSettings settings = small();
  settings.samples = 301;
  settings.reflection_length_mm = 0.9;
  settings.contact_mm = 2;
  settings.shadows = false;
  settings.reflection_share = 0.8;
  check_parity(settings, linear, test::on_the_skin(-10, 1, -8));
}

TEST_CASE("model W: images of one call are those of a call each, over more than one chunk") {
  Fixture f;
  f.settings.samples = 971;  // a chunk of 16 MiB holds 70 images of 61 lines, or 68 where a texel holds four
  const std::vector<Pose> all = poses(201);  // the last chunk holds another number of images
  gl::WeinSimulator simulator(f.body, f.probe, kDepth_mm, test::exact_as_needed(f.settings));
  for (const int count : {201, 23, 22, 3, 2}) {  // the last group of four interleaved images holds one, three or two
    const gl::Texture& grid = simulator.simulate(std::span(all).first(std::size_t(count)));
    Image<std::uint8_t> tiles(grid.width(), grid.height());
    grid.read(GL_RED, GL_UNSIGNED_BYTE, tiles.pixels.data(), tiles.pixels.size());
    std::vector<glm::ivec2> corners;
    for (int i = 0; i < count; ++i) corners.push_back(simulator.tile(i));
    for (const int i : {0, 1, 2, 3, 8, 9, 20, 21, 22, 67, 68, 69, 135, 136, 199, 200}) {
      if (i >= count) break;
      const Image<std::uint8_t> alone = simulator.read_stages(all[std::size_t(i)]).grey;
      bool same = true;
      for (int y = 0; y < alone.height; ++y)
        for (int x = 0; x < alone.width; ++x)
          same = same && alone.at(x, y) == tiles.at(corners[std::size_t(i)].x + x, corners[std::size_t(i)].y + y);
      CAPTURE(count, i);
      CHECK(same);
      const int brightest = *std::max_element(alone.pixels.begin(), alone.pixels.end());
      CHECK((brightest > 60) != in_the_air(i));
    }
  }
}

TEST_CASE("model W's stages report how often they ran and how much they evaluated of what there is") {
  Fixture f;
  using Stage = gl::WeinStage;
  const auto count = [&](Stage stage) { return f.simulator.count(stage); };
  CHECK(count(Stage::traverse).runs == 0);
  CHECK(count(Stage::traverse).possible == 0);

  const std::size_t images = 21;  // odd: the last image has no neighbour
  const std::uint64_t samples = images * 61 * 91, pixels = images * 70 * 50;
  const auto& inside = f.simulator.inside().pixels;
  const auto in_fan = std::uint64_t(std::count(inside.begin(), inside.end(), std::uint8_t(1))) * images;
  f.simulator.simulate(poses(int(images)));
  CHECK(count(Stage::traverse).runs == 1);
  CHECK(count(Stage::traverse).possible == samples);
  CHECK(count(Stage::traverse).evaluated > samples / 2);
  CHECK(count(Stage::traverse).evaluated < samples);  // some lines end in gas
  CHECK(count(Stage::scan_convert).runs == 1);
  CHECK(count(Stage::scan_convert).possible == pixels);
  CHECK(count(Stage::scan_convert).evaluated == in_fan);
  CHECK(in_fan < pixels);
  CHECK(count(Stage::compare).runs == 0);

  Image<float> ultrasound = f.ultrasound_like(f.expected(f.pose), 50, 10, 0.1);
  for (int y = 0; y < ultrasound.height; ++y) ultrasound.at(35, y) = NAN;
  f.simulator.set_ultrasound(ultrasound);
  f.simulator.similarity(poses(int(images)));
  CHECK(count(Stage::traverse).runs == 2);
  CHECK(count(Stage::traverse).evaluated > samples / 2);
  CHECK(count(Stage::traverse).evaluated < samples);
  CHECK(count(Stage::scan_convert).runs == 1);  // comparing needs no image
  CHECK(count(Stage::compare).runs == 1);
  CHECK(count(Stage::compare).possible == pixels);
  CHECK(count(Stage::compare).evaluated > in_fan / 2);
  CHECK(count(Stage::compare).evaluated < in_fan);  // masked pixels do not count

  f.settings.shadows = false;  // then nothing needs I, and lines end where the CT ends
  gl::WeinSimulator unshadowed(f.body, f.probe, kDepth_mm, test::exact_as_needed(f.settings));
  for (const std::size_t some : {1, 2, 3}) {
    CAPTURE(some);
    const std::vector<Pose> few = poses(int(some));
    std::uint64_t in_ct = 0;
    for (const Pose& pose : few) in_ct += f.samples_in_ct(pose);
    unshadowed.simulate(few);
    CHECK(unshadowed.count(Stage::traverse).evaluated >= in_ct);
    // A line is traversed in pairs of samples, and two images until neither is in the CT.
    CHECK(unshadowed.count(Stage::traverse).evaluated <=
          std::min<std::uint64_t>(in_ct + some * 61 * 6, some * 61 * 91));
    CHECK(in_ct < some * 61 * 91);
  }
  Pose away = f.pose;
  away.translation.y = -500;
  unshadowed.simulate({&away, 1});
  CHECK(unshadowed.count(Stage::traverse).evaluated <= 61 * 8);  // only the contact's samples, which show water
}

TEST_CASE("model W runs nothing for the poses of the call before") {
  Fixture f;
  using Stage = gl::WeinStage;
  const auto ran = [&](Stage stage) { return f.simulator.count(stage).runs; };
  const std::vector<Pose> some = poses(3), others = poses(4);
  f.simulator.simulate(some);
  f.simulator.simulate(some);
  CHECK(ran(Stage::traverse) == 1);
  CHECK(ran(Stage::scan_convert) == 1);
  f.simulator.simulate(others);
  f.simulator.simulate(some);
  CHECK(ran(Stage::traverse) == 3);

  const Image<float> ultrasound = f.ultrasound_like(f.expected(f.pose), 90, 30, 0.4);
  f.simulator.set_ultrasound(ultrasound);
  const std::vector<float> similarity = f.simulator.similarity(some);
  CHECK(f.simulator.similarity(some) == similarity);
  CHECK(ran(Stage::compare) == 1);
  f.simulator.set_ultrasound(f.ultrasound_like(f.expected(f.pose), 90, 30, 0.1));
  CHECK(f.simulator.similarity(some) != similarity);
  CHECK(ran(Stage::compare) == 2);
}

TEST_CASE("LC2: GLSL agrees with the reference for every image of a call") {
  Fixture f;
  const Image<float> ultrasound = f.ultrasound_like(f.expected(f.pose), 90, 30, 0.4);
  f.simulator.set_ultrasound(ultrasound);
  const std::vector<Pose> all = poses(201);
  const std::vector<float> got = f.simulator.similarity(all);
  REQUIRE(got.size() == all.size());
  const Image<double> u = [&] {
    Image<double> image(ultrasound.width, ultrasound.height);
    std::copy(ultrasound.pixels.begin(), ultrasound.pixels.end(), image.pixels.begin());
    return image;
  }();
  for (const std::size_t i : {0, 3, 8, 11, 94, 95, 199, 200}) {
    const WeinStages<double> stages = f.expected(all[i]);
    const double expected = lc2_reference(u, f.simulator.inside(), stages.echogenicity, stages.reflection);
    CAPTURE(i);
    // The terms are accurate to 1e-4 of their range; they vary by a tenth of it or more.
    CHECK(got[i] == Approx(expected).margin(1e-3));
  }
}

TEST_CASE("LC2 by patches: GLSL agrees with the reference, and feels no gain that varies over the picture") {
  Fixture f;
  WeinSettings settings = small();
  settings.similarity_patch = 12;  // divides neither side evenly
  gl::WeinSimulator by_patches(f.body, f.probe, kDepth_mm, test::exact_as_needed(settings));
  const WeinStages<double> stages = f.expected(f.pose);
  Image<float> ultrasound = f.ultrasound_like(stages, 90, 30, 0.4);
  const auto check = [&](bool fading) {
    if (fading)
      for (int y = 0; y < ultrasound.height; ++y)
        for (int x = 0; x < ultrasound.width; ++x)
          ultrasound.at(x, y) *= float(std::exp(-0.07 * y)) * (x < ultrasound.width / 2 ? 1.0f : 0.3f);
    by_patches.set_ultrasound(ultrasound);
    Image<double> u(ultrasound.width, ultrasound.height);
    std::copy(ultrasound.pixels.begin(), ultrasound.pixels.end(), u.pixels.begin());
    const std::vector<Pose> all = poses(40);
    const std::vector<float> got = by_patches.similarity(all);
    for (const std::size_t i : {0, 3, 11, 39}) {
      const WeinStages<double> at = f.expected(all[i]);
      CAPTURE(i, fading);
      CHECK(got[i] == Approx(lc2_reference(u, by_patches.inside(), at.echogenicity, at.reflection, 12)).margin(1e-3));
    }
    f.simulator.set_ultrasound(ultrasound);
    return std::pair(by_patches.similarity({&f.pose, 1}).front(), f.simulator.similarity({&f.pose, 1}).front());
  };
  const auto even = check(false), faded = check(true);
  CHECK(faded.first > even.first - 0.1);
  CHECK(faded.second < even.second - 0.15);
}

TEST_CASE("LC2 is 1 for an affine map of the image's own terms, and feels neither gain nor offset") {
  Fixture f;
  const WeinStages<double> stages = f.expected(f.pose);
  CHECK(f.similarity(f.ultrasound_like(stages, 1, 0, 0), f.pose) == Approx(1).margin(1e-4));
  const double partly = f.similarity(f.ultrasound_like(stages, 1, 0, 1), f.pose);
  CHECK(partly > 0.1);
  CHECK(partly < 0.9);
  // A float holds 1e5 plus its speckle to 0.004: 1e-5 of the image's variation.
  for (const auto& [gain, offset] :
       {std::pair(255.0, 0.0), std::pair(-3.0, 12.0), std::pair(1000.0, 1e5), std::pair(1e30, 0.0)})
    CHECK(f.similarity(f.ultrasound_like(stages, gain, offset, 1), f.pose) == Approx(partly).margin(1e-4));
}

TEST_CASE("LC2 is largest where the probe was") {
  Fixture f;
  f.simulator.set_ultrasound(f.ultrasound_like(f.expected(f.pose), 200, 10, 0.3));
  std::vector<Pose> around;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) {
        Pose moved = f.pose;
        moved.translation += moved.direction(2.0 * glm::dvec3(x, y, z));
        around.push_back(moved);
      }
  const std::vector<float> similarity = f.simulator.similarity(around);
  const auto best = std::max_element(similarity.begin(), similarity.end()) - similarity.begin();
  CHECK(best == 62);  // the middle of 5 x 5 x 5
  CHECK(similarity[62] > similarity[61] + 0.01);
  CHECK(similarity[62] > similarity[0] + 0.1);
}

TEST_CASE("LC2 counts no pixel outside the fan and none that is masked") {
  Fixture f;
  const Image<float> clean = f.ultrasound_like(f.expected(f.pose), 1, 0, 0.5);
  const double expected = f.similarity(clean, f.pose);
  Image<float> outside = clean;
  for (std::size_t i = 0; i < outside.pixels.size(); ++i)
    if (!f.simulator.inside().pixels[i]) outside.pixels[i] = 1e6f;
  CHECK(f.similarity(outside, f.pose) == expected);

  // A label burnt into the picture matters until it is masked.
  Image<float> burnt = clean, masked = clean;
  for (int y = 20; y < 30; ++y)
    for (int x = 30; x < 40; ++x) {
      burnt.at(x, y) = 1e3f;
      masked.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  CHECK(f.similarity(burnt, f.pose) < 0.2 * expected);
  CHECK(f.similarity(masked, f.pose) == Approx(expected).margin(0.1));
}

TEST_CASE("LC2 is 0 where there is nothing to compare") {
  Fixture f;
  CHECK(f.simulator.similarity(std::span<const Pose>()).empty());
  CHECK(f.simulator.similarity({&f.pose, 1}).front() == 0);  // no ultrasound image yet
  const WeinSettings& s = f.settings;
  CHECK(f.similarity(Image<float>(s.image_width, s.image_height, 0.1f), f.pose) == 0);
  CHECK(f.similarity(Image<float>(s.image_width, s.image_height, std::numeric_limits<float>::quiet_NaN()), f.pose) ==
        0);
  Pose in_air = f.pose;  // both terms are constant
  in_air.translation.y = -500;
  const Image<float> ultrasound = f.ultrasound_like(f.expected(f.pose), 1, 0, 0);
  CHECK(f.similarity(ultrasound, f.pose) > 0.9);
  CHECK_THROWS_AS(f.simulator.set_ultrasound(Image<float>(3, 3)), std::invalid_argument);
  WeinSettings without_contact = s;
  without_contact.contact_mm = 0;
  gl::WeinSimulator bare(f.body, f.probe, kDepth_mm, without_contact);
  bare.set_ultrasound(ultrasound);
  CHECK(bare.similarity({&in_air, 1}).front() == 0);
}

TEST_CASE("lines that do not bend give the LC2 of straight ones, patch by patch, for one image and for many") {
  Fixture f;
  f.settings.similarity_patch = 8;
  gl::WeinSimulator simulator(f.body, f.probe, kDepth_mm, test::exact_as_needed(f.settings));
  simulator.set_ultrasound(f.ultrasound_like(f.expected(f.pose), 40, 7, 0.3));
  CHECK(simulator.patches_across() == 9);
  CHECK(simulator.patches_down() == 7);
  for (const std::size_t count : {1, 5}) {
    std::vector<glm::dmat4> places;
    for (std::size_t i = 0; i < count; ++i)
      places.push_back(test::on_the_skin(2.0 * double(i), 9, 12 - double(i)).matrix());
    const std::vector<glm::vec3> none(count * simulator.bend_nodes().size(), glm::vec3(0.0f));
    const std::vector<float> patches = simulator.patch_similarity(places, none), whole = simulator.similarity(places);
    REQUIRE(patches.size() == count * 63);
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0;
      for (std::size_t patch = 0; patch < 63; ++patch) sum += patches[63 * i + patch];
      CHECK(whole[i] > 0.1);
      // Lines that bend are computed node by node, which rounds differently.
      CHECK(sum == Approx(whole[i]).margin(1e-4));
    }
  }
}

TEST_CASE("lines that bend as an affine map moves them give its LC2") {
  Fixture f;
  f.settings.similarity_patch = 8;
  f.probe = *find_probe("linear");  // whose lines an affine map leaves evenly apart
  f.probe.lines = 61;
  gl::WeinSimulator simulator(f.body, f.probe, kDepth_mm, test::exact_as_needed(f.settings));
  const WeinStages<double> like =
      wein_reference(wein_field(f.body, f.settings.reflection_length_mm), f.probe, kDepth_mm, f.settings, f.pose);
  simulator.set_ultrasound(f.ultrasound_like(like, 40, 7, 0.3));
  glm::dmat4 moved(1.0);
  moved[0] = {1.04, 0.02, 0, 0};
  moved[1] = {-0.03, 0.95, 0.04, 0};
  moved[3] = {1.5, -1, 2, 1};
  for (const std::size_t count : {1, 3}) {
    std::vector<glm::dmat4> straight, bent;
    std::vector<glm::vec3> bends;
    for (std::size_t i = 0; i < count; ++i) {
      straight.push_back(test::on_the_skin(3.0 * double(i), 9, 12).matrix());
      bent.push_back(moved * straight.back());
      for (const glm::dvec3& node : simulator.bend_nodes())
        bends.emplace_back(glm::dvec3((bent.back() - straight.back()) * glm::dvec4(node, 1)));
    }
    const std::vector<float> expected = simulator.similarity(bent), unmoved = simulator.similarity(straight),
                             patches = simulator.patch_similarity(straight, bends);
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0;
      for (std::size_t patch = 0; patch < 63; ++patch) sum += patches[63 * i + patch];
      CHECK(std::abs(expected[i] - unmoved[i]) > 0.01);
      CHECK(sum == Approx(expected[i]).margin(2e-4));
    }
  }
}

TEST_CASE("a bend behind a patch changes nothing in it") {
  Fixture f;
  f.settings.similarity_patch = 8;
  gl::WeinSimulator simulator(f.body, f.probe, kDepth_mm, test::exact_as_needed(f.settings));
  simulator.set_ultrasound(f.ultrasound_like(f.expected(f.pose), 40, 7, 0.3));
  const std::vector<glm::dvec3>& nodes = simulator.bend_nodes();
  const glm::dmat4 place = f.pose.matrix();
  std::vector<glm::vec3> bends(nodes.size(), glm::vec3(0.0f));
  const std::vector<float> before = simulator.patch_similarity({&place, 1}, bends);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].y > 70) bends[i] = {0, 0, 4};
  const std::vector<float> after = simulator.patch_similarity({&place, 1}, bends);
  double changed = 0;
  for (int row = 0; row < simulator.patches_down(); ++row)
    for (int column = 0; column < simulator.patches_across(); ++column) {
      const auto n = std::size_t(row * simulator.patches_across() + column);
      const double deepest = simulator.geometry().plane_mm(8 * column, 8 * row + 8).y;
      if (deepest < 60) CHECK(after[n] == Approx(before[n]).margin(1e-6));
      changed += std::abs(after[n] - before[n]);
    }
  CHECK(changed > 0.01);
}

TEST_CASE("bends that make no sense are refused") {
  Fixture f;
  const glm::dmat4 place = f.pose.matrix();
  std::vector<glm::vec3> bends(f.simulator.bend_nodes().size());
  CHECK_THROWS_AS(f.simulator.patch_similarity({&place, 1}, bends), std::invalid_argument);  // no patches
  f.settings.similarity_patch = 8;
  gl::WeinSimulator simulator(f.body, f.probe, kDepth_mm, f.settings);
  CHECK_THROWS_AS(simulator.patch_similarity({&place, 1}, std::span(bends).first(5)), std::invalid_argument);
  bends[7].y = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(simulator.patch_similarity({&place, 1}, bends), std::invalid_argument);
}
