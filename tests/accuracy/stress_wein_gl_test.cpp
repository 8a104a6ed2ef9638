// Takes model W to the ends of its ranges, as stress_gl_test.cpp does with model S, under the same conditions where
// both models share them.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/wein/wein_reference.h"
#include "sim/wein/wein_settings_file.h"
#include "sim/wein/wein_simulator.h"
#include "tests/accuracy/extreme_cases.h"
#include "tests/accuracy/stress_bounds.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/parity.h"

using namespace insonate;
using namespace insonate::test;

namespace {

struct WeinScene {
  Scene place;
  WeinSettings settings;
};

/// Converts a scene; what both models share stays as it is.
WeinScene as_model_w(Scene scene) {
  WeinSettings settings;
  settings.samples = scene.settings.samples;
  settings.reflection_length_mm = scene.settings.reflection_length_mm;
  settings.contact_mm = scene.settings.gel_mm;
  settings.image_width = scene.settings.image_width;
  settings.image_height = scene.settings.image_height;
  return {std::move(scene), settings};
}

template <typename Real>
std::string out_of_bounds(const WeinStages<Real>& stages, const Image<std::uint8_t>& inside) {
  constexpr double kOne = 1 + 1e-6;  // the quotient of two logarithms may exceed 1 slightly
  if (const auto fault = outside("I", stages.intensity, 1)) return *fault;
  if (const auto fault = outside("E", stages.scan_echogenicity, 1)) return *fault;
  if (const auto fault = outside("R", stages.scan_reflection, kOne)) return *fault;
  const std::size_t lines = std::size_t(stages.intensity.width);
  for (std::size_t i = lines; i < stages.intensity.pixels.size(); ++i)
    if (stages.intensity.pixels[i] > stages.intensity.pixels[i - lines]) return at("rising I", stages.intensity, i);
  for (std::size_t i = 0; i < stages.grey.pixels.size(); ++i)
    if (stages.grey.pixels[i] && !inside.pixels[i]) return at("grey outside the fan", stages.grey, i);
  return "";
}

/// What model W meets in a volume with the gradient that sim/wein/density_volume.h stores: differences at the
/// voxels, clipped to the range of 16 bits.
class StoredMedium {
public:
  StoredMedium(const AcousticVolume& volume, double reflection_length_mm)
      : grid_(volume.grid), exact_(wein_field(volume, reflection_length_mm)), differences_(grid_.count()) {
    for (int z = 0; z < grid_.size.z; ++z)
      for (int y = 0; y < grid_.size.y; ++y)
        for (int x = 0; x < grid_.size.x; ++x) {
          const glm::dvec3 gradient = exact_(grid_.patient_from_index({x, y, z})).gradient_hu;
          const glm::dvec3 along_axes = glm::transpose(grid_.direction) * gradient;
          cut_off_ = cut_off_ || glm::any(glm::greaterThan(glm::abs(along_axes), glm::dvec3(kMax)));
          differences_[grid_.offset({x, y, z})] = glm::clamp(along_axes, -kMax, kMax);
        }
  }

  /// Returns the reference's own field unless something is clipped.
  WeinField field() const { return cut_off_ ? between(differences_) : exact_; }

  /// Returns the field with the differences rounded to the stored steps.
  /// @param draw  decides which way differences are rounded that lie in the middle between two steps
  WeinField rounded(std::uint32_t draw) const {
    std::vector<glm::dvec3> stored = differences_;
    std::uint32_t count = 0;
    for (glm::dvec3& along_axes : stored)
      for (int axis = 0; axis < 3; ++axis)
        along_axes[axis] =
            std::round(along_axes[axis] * kStepsPerHu + 1e-6 * (unit_float(hash(draw, count++)) - 0.5)) / kStepsPerHu;
    return between(std::move(stored));
  }

private:
  static constexpr double kStepsPerHu = 8, kMax = 32767 / kStepsPerHu;

  WeinField between(std::vector<glm::dvec3> differences) const {
    return [grid = grid_, exact = exact_, differences = std::move(differences)](const glm::dvec3& p) {
      WeinMedium medium = exact(p);
      const glm::dvec3 index = grid.index_from_patient(p), floor = glm::floor(index), f = index - floor;
      glm::dvec3 along_axes(0);
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 step(corner & 1, corner >> 1 & 1, corner >> 2 & 1), i = floor + step;
        if (glm::any(glm::lessThan(i, glm::dvec3(0))) || glm::any(glm::greaterThanEqual(i, glm::dvec3(grid.size))))
          continue;
        const glm::dvec3 weight = glm::mix(1.0 - f, f, step);
        along_axes += weight.x * weight.y * weight.z * differences[grid.offset(glm::ivec3(i))];
      }
      medium.gradient_hu = grid.direction * along_axes;
      return medium;
    };
  }

  Grid grid_;
  WeinField exact_;
  std::vector<glm::dvec3> differences_;  // HU along the grid's axes, per voxel
  bool cut_off_ = false;
};

/// Counts pixels that are not black, and those of them whose grey is known to one level.
struct Compared {
  long lit = 0, known = 0;

  double share() const { return double(known) / double(std::max(lit, 1L)); }
};

class Stressed {
public:
  /// Checks bounds only.
  void check_shaders(const WeinScene& scene) {
    REQUIRE(why_not_valid(scene.settings).value_or("") == "");
    gl::WeinSimulator simulator(scene.place.volume, scene.place.probe, scene.place.depth_mm,
                                exact_as_needed(scene.settings));
    got_ = simulator.read_stages(scene.place.pose);
    inside_ = simulator.inside();
    CHECK(out_of_bounds(got_, inside_) == "");
    Image<float> ultrasound(scene.settings.image_width, scene.settings.image_height);
    for (std::size_t i = 0; i < ultrasound.pixels.size(); ++i)
      ultrasound.pixels[i] = unit_float(hash(std::uint32_t(i)));
    simulator.set_ultrasound(ultrasound);
    const float similarity = simulator.similarity({&scene.place.pose, 1}).front();
    CHECK(similarity >= 0);  // false for NaN too
    CHECK(similarity <= 1);
  }

  /// Checks the bounds of both, and their agreement.
  void check(const WeinScene& scene) {
    check_shaders(scene);
    const Scene& place = scene.place;
    // The graphics card's normalised integers have no -32768.
    AcousticVolume volume = place.volume;
    double densest = 1000;
    for (AcousticVoxel& voxel : volume.voxels) {
      voxel.hu = std::max(voxel.hu, std::int16_t(-32767));
      densest = std::max(densest, std::abs(double(voxel.hu)));
    }
    const StoredMedium medium(volume, scene.settings.reflection_length_mm);
    const auto reference = [&](const WeinField& of) {
      return wein_reference(of, place.probe, place.depth_mm, scene.settings, place.pose);
    };
    const WeinStages<double> expected = reference(medium.field());
    REQUIRE(out_of_bounds(expected, inside_) == "");

    // As in parity.h, for scenes of any size and density: the uncertainty of a place grows with the largest distance.
    const Grid& grid = place.volume.grid;
    const double reach =
        glm::length(grid.spacing * glm::dvec3(grid.size)) + glm::length(place.pose.translation) + place.depth_mm;
    std::array<WeinStages<double>, 4> uncertain;
    for (std::uint32_t i = 0; i < uncertain.size(); ++i)
      uncertain[i] = reference(
          [field = medium.rounded(i), i, reach, densest, count = std::uint32_t(0)](const glm::dvec3& p) mutable {
            const auto random = [&] { return 2.0 * unit_float(hash(i, count++)) - 1.0; };
            WeinMedium there = field(p + 2e-7 * reach * glm::dvec3(random(), random(), random()));
            there.hu += 2e-7 * densest * random();
            return there;
          });
    const auto agree = [&](const char* what, Image<double> WeinStages<double>::*stage, const Image<float>& image,
                           auto&& basic) {
      const Image<double> allowed = tolerated(expected, uncertain, stage, basic);
      const Worst found = worst(expected.*stage, image, allowed);
      INFO(described(what, found));
      CHECK(found.error < 1);
      return allowed;
    };
    const auto of_a_term = [](double) { return 1e-4; };
    agree("I", &WeinStages<double>::intensity, got_.intensity, [](double i) { return 1e-4 * std::max(i, 1e-6); });
    const Image<double> of_reflection =
        agree("R", &WeinStages<double>::scan_reflection, got_.scan_reflection, of_a_term);
    const Image<double> of_echogenicity =
        agree("E", &WeinStages<double>::scan_echogenicity, got_.scan_echogenicity, of_a_term);
    check_grey(scene, expected, of_reflection, of_echogenicity);
  }

  /// Returns the counts over all scenes passed to check().
  const Compared& compared() const { return compared_; }

private:
  /// Compares the picture with the values that the reference's is rounded from. Half a level is the picture's own
  /// rounding. A pixel may differ as much as s R + (1 - s) E may at the samples around it. That sum is stored in 16
  /// bits, as are the compared terms: half a step of each. Its place among lines and samples is known in single
  /// precision.
  void check_grey(const WeinScene& scene, const WeinStages<double>& expected, const Image<double>& of_reflection,
                  const Image<double>& of_echogenicity) {
    const double s = scene.settings.reflection_share;
    const int lines = expected.intensity.width, samples = expected.intensity.height;
    Image<double> sum(lines, samples), sum_allowed(lines, samples);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
      sum.pixels[i] = s * expected.scan_reflection.pixels[i] + (1 - s) * expected.scan_echogenicity.pixels[i];
      sum_allowed.pixels[i] = s * of_reflection.pixels[i] + (1 - s) * of_echogenicity.pixels[i] + 1.0 / 65535;
    }
    const ScanLines placed = scan_lines(scene.place.probe, scene.place.depth_mm, samples);
    const ImageGeometry picture = image_geometry(scene.place.probe, scene.place.depth_mm, scene.settings.image_width,
                                                 scene.settings.image_height);
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const auto at = line_position(scene.place.probe, scene.place.depth_mm, picture.plane_mm(x, y));
        REQUIRE(at.has_value() == bool(inside_.at(x, y)));
        if (!at) continue;
        const int line = int(std::floor(at->line)),
                  k = int(std::floor((at->r_mm - placed.r_min_mm) / placed.dr_mm() - 0.5));
        double allowed = 0, least = 1, most = 0;
        // The surrounding samples, and one more on each side in case the place is rounded past one of them.
        for (int j = line - 1; j <= line + 2; ++j)
          for (int i = k - 1; i <= k + 2; ++i) {
            const int at_line = std::clamp(j, 0, lines - 1), at_sample = std::clamp(i, 0, samples - 1);
            allowed = std::max(allowed, sum_allowed.at(at_line, at_sample));
            least = std::min(least, sum.at(at_line, at_sample));
            most = std::max(most, sum.at(at_line, at_sample));
          }
        allowed += 6e-8 * (lines + samples) * (most - least);
        const double levels = 255 * (s * expected.reflection.at(x, y) + (1 - s) * expected.echogenicity.at(x, y));
        const double error = std::abs(got_.grey.at(x, y) - levels);
        if (error > 0.5 + 255 * allowed) {
          FAIL_CHECK("grey at (" << x << ", " << y << ") is " << int(got_.grey.at(x, y)) << ", reference " << levels
                                 << ", tolerated " << 0.5 + 255 * allowed);
          return;
        }
        compared_.lit += levels > 0.5;
        compared_.known += levels > 0.5 && 255 * allowed < 1;
      }
  }

  test::TestContext context_;
  WeinStages<float> got_;
  Image<std::uint8_t> inside_;
  Compared compared_;
};

/// Checks that most lit pixels are known to one level. The share is least, 0.85, with a compression that makes the
/// rounding of the stored gradient visible.
void check_known(const Compared& before, const Compared& all) {
  const Compared since{all.lit - before.lit, all.known - before.known};
  CHECK((since.lit == 0 || since.share() > 0.8));
}

/// Runs `cases` one by one, each on an otherwise ordinary scene.
void check_each(const std::vector<ExtremeCase>& cases) {
  Stressed stressed;
  for (const ExtremeCase& extreme : cases) {
    INFO(extreme.name);
    Scene scene = ordinary_scene();
    extreme.apply(scene);
    const Compared before = stressed.compared();
    stressed.check(as_model_w(std::move(scene)));
    check_known(before, stressed.compared());
  }
  CHECK(stressed.compared().lit > 0);
}

}  // namespace

TEST_CASE("model W: what both models are given, at the ends of its ranges") {
  check_each(extreme_views());
}

TEST_CASE("model W: volumes at the ends of what a grid and a voxel can hold") {
  const int side = GENERATE(1, 2);
  const std::vector<ExtremeCase> beside_the_densest = {
      {"air beside 32767", board({8, 8, 8}, {10, 10, 10}, -1000, 32767, side)},
      {"water beside 32767", board({8, 8, 8}, {10, 10, 10}, 0, 32767, side)},
      {"bone beside 32767", board({8, 8, 8}, {10, 10, 10}, 1500, 32767, side)},
  };
  check_each(joined(extreme_volumes(side), beside_the_densest));
}

TEST_CASE("model W: thousands of interfaces in a row") {
  check_each(layers_in_a_row(GENERATE(1, 2)));
}

TEST_CASE("model W: sound that hardly fades, over 40,000 reflection lengths") {
  const auto slopes = [](int hu_per_voxel) {
    return [=](Scene& scene) {
      scene.volume = make_volume({2, 2000, 2}, {400, 0.4, 400},
                                 [=](const glm::ivec3& i) { return hu_per_voxel * std::abs(i.y % 40 - 20); });
      scene.probe.kind = ProbeKind::linear;
      scene.probe.lines = 4;
      scene.depth_mm = 800;
      scene.settings.samples = 1000;
      scene.settings.reflection_length_mm = 0.02;
      scene.settings.image_width = 1;  // along the middle
      scene.settings.image_height = 40;
      scene.pose.translation = {0, -400, 0};
    };
  };
  // Each reflection length takes about 1.2e-8, 5e-8 and 2e-7 of it. Below 1, single precision has steps of 6e-8.
  check_each({
      {"5 HU a voxel", slopes(5)},
      {"10 HU a voxel", slopes(10)},
      {"20 HU a voxel", slopes(20)},
  });
}

TEST_CASE("model W: extreme poses give finite and bounded stages") {
  check_each(extreme_poses());
}

TEST_CASE("model W: settings at the ends of their ranges") {
  using W = WeinSettings;
  const auto set = [](auto W::*member, auto value) { return [=](W& settings) { settings.*member = value; }; };
  const struct {
    const char* name;
    std::function<void(W&)> apply;
  } cases[] = {
      {"nothing extreme", [](W&) {}},
      {"compression 0.001", set(&W::compression, 0.001)},
      {"compression 1e6", set(&W::compression, 1e6)},
      {"echogenicity from nothing to all within 1 HU", set(&W::bright_hu, -49.0)},
      {"echogenicity over all densities",
       [](W& settings) {
         settings.dark_hu = -1000;
         settings.bright_hu = 3000;
       }},
      {"no shadows", set(&W::shadows, false)},
      {"reflections alone", set(&W::reflection_share, 1.0)},
      {"echogenicity alone", set(&W::reflection_share, 0.0)},
      {"exact filtering", set(&W::exact_filter, true)},
  };
  Stressed stressed;
  for (const auto& extreme : cases) {
    INFO(extreme.name);
    WeinScene scene = as_model_w(ordinary_scene());
    scene.settings.reflection_length_mm = WeinSettings{}.reflection_length_mm;
    extreme.apply(scene.settings);
    const Compared before = stressed.compared();
    stressed.check(scene);
    check_known(before, stressed.compared());
  }
}

TEST_CASE("model W: random scenes, each from its seed") {
  const long frames = from_environment("INSONATE_STRESS_FRAMES", 25);
  const long first = from_environment("INSONATE_STRESS_SEED", 1);
  Stressed stressed;
  for (long seed = first; seed < first + frames; ++seed) {
    INFO("seed " << seed);
    stressed.check({random_scene_at_body(std::uint32_t(seed)), random_wein_settings(std::uint32_t(seed))});
  }
  CHECK(stressed.compared().share() > 0.95);  // 0.998 with 300 scenes
}
