#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/phantom/arithmetic.h"
#include "sim/phantom/phantom.h"
#include "sim/phantom/shapes.h"
#include "sim/phantom/texture.h"

using namespace insonate;

namespace {

using Options = std::vector<std::pair<std::string, std::string>>;

// A box of 40 mm of fat, with whatever is added to it.
std::string small_recipe(const std::string& shapes, const std::string& more = "") {
  return R"(name = "Test"
seed = 7
grid = { from = [-20, -20, -20], to = [20, 20, 20], voxel_mm = 1 }
options.size_mm = { default = 10, least = 1, most = 15, about = "a radius" }
options.extra = { default = false, about = "a switch" }
labels = [
  { name = "fat", tissue = "fat", hu = -100 },
  { name = "organ", tissue = "liver", hu = 60 },
  { name = "rough", tissue = "spleen", hu = 50, texture_hu = 10, grain_mm = 3 },
]
shapes = [
  { name = "all", kind = "box", centre = [0, 0, 0], half_sizes = [30, 30, 30], label = "fat" },
)" + shapes +
         "\n]\n" + more;
}

Case make(const std::string& shapes, const Options& options = {}, const std::string& more = "") {
  return make_phantom("test.toml", small_recipe(shapes, more), options);
}

// From the Hounsfield units, in which an edge voxel counts by its share: the volume in mm^3 of what is `hu` in -100.
double volume_by_hu(const Case& subject, double hu) {
  double sum = 0;
  for (const std::int16_t value : subject.ct.voxels) sum += (value + 100) / (hu + 100);
  return sum;
}

std::size_t count(const Case& subject, const std::string& label) {
  const std::uint8_t value = subject.find_label(label)->value;
  return std::size_t(std::count(subject.labels.voxels.begin(), subject.labels.voxels.end(), value));
}

constexpr double kPi = 3.14159265358979;

// Tolerances of volumes: an edge one voxel wide on a ball of radius r adds h^2 / (4 r^2): 1 % at 5 mm, 0.25 % at 10 mm.

}  // namespace

TEST_CASE("solids have the volumes that geometry gives, edges counted by their share") {
  struct Solid {
    const char* text;
    double mm3;
    double within;  // a share; the distance is exact to first order only, which thin and slender solids feel
  };
  const std::vector<Solid> solids{
      {R"(kind = "ellipsoid", centre = [0.3, -0.2, 0.1], radii = [12, 12, 12])", 4 / 3.0 * kPi * 12 * 12 * 12, 0.003},
      {R"(kind = "ellipsoid", centre = [0, 0, 0], radii = [15, 10, 6])", 4 / 3.0 * kPi * 15 * 10 * 6, 0.01},
      {R"(kind = "box", centre = [0, 0, 0], half_sizes = [8, 6, 4])", 16 * 12 * 8, 0.01},
      {R"(kind = "tube", points = [[0, 0, -10, 5], [0, 0, 10, 5]])", kPi * 25 * 20 + 4 / 3.0 * kPi * 125, 0.01},
      {R"(kind = "tube", points = [[0, 0, -10], [0, 0, 10]], radius_mm = 6, flatness = 0.5, flat_towards = [0, 500, 0])",
       kPi * 6 * 3 * 20 + 4 / 3.0 * kPi * 6 * 6 * 3, 0.03},
      {R"(kind = "loft", sections = [[-10, 0, 0, 9, 6, 6], [10, 0, 0, 9, 6, 6]])", kPi * 9 * 6 * 20, 0.01},
      {R"(kind = "loft", sections = [[-10, 0, 0, 9, 6, 3], [10, 0, 0, 9, 6, 3]])", kPi * 9 * 4.5 * 20, 0.02},
      {R"(kind = "half_space", point = [0, 0, 5], normal = [0, 0, 2])", 40 * 40 * 25, 0.001},
  };
  for (const Solid& solid : solids) {
    INFO(solid.text);
    const Case subject = make(std::string(R"({ name = "solid", label = "organ", )") + solid.text + " },");
    const double volume = volume_by_hu(subject, 60);
    INFO(volume << " for " << solid.mm3);
    CHECK(std::abs(volume - solid.mm3) < solid.within * solid.mm3);
    CHECK(std::abs(double(count(subject, "organ")) - solid.mm3) < 0.03 * solid.mm3);
  }
}

TEST_CASE("shapes are joined, cut, moved and mirrored as the recipe says") {
  const std::string ball = R"({ name = "ball", kind = "ellipsoid", centre = [0, 0, 0], radii = [10, 10, 10] },
    { name = "upper", kind = "half_space", point = [0, 0, 0], normal = [0, 0, -1] },
    { name = "right", kind = "half_space", point = [0, 0, 0], normal = [1, 0, 0] },
    )";
  const double whole = 4 / 3.0 * kPi * 1000;
  const auto volume = [&](const std::string& text) {
    return volume_by_hu(make(ball + R"({ name = "made", label = "organ", )" + text + " },"), 60);
  };
  const auto shell = [](double r, double s) { return 4 / 3.0 * kPi * (r * r * r - s * s * s); };
  CHECK(volume(R"(kind = "copy", of = "ball")") == Approx(whole).epsilon(0.005));
  CHECK(volume(R"(kind = "intersection", of = ["ball", "upper"])") == Approx(whole / 2).epsilon(0.005));
  CHECK(volume(R"(kind = "intersection", of = ["ball", "upper", "right"])") == Approx(whole / 4).epsilon(0.01));
  CHECK(volume(R"(kind = "difference", of = "ball", minus = ["upper"])") == Approx(whole / 2).epsilon(0.005));
  CHECK(volume(R"(kind = "copy", of = "ball", inside = ["upper"], inset_mm = 10)") == Approx(0).margin(5));
  CHECK(volume(R"(kind = "offset", of = "ball", by_mm = 2)") == Approx(shell(12, 0)).epsilon(0.005));
  CHECK(volume(R"(kind = "shell", of = "ball", inner_mm = -3, outer_mm = 0)") == Approx(shell(10, 7)).epsilon(0.01));
  CHECK(volume(R"(kind = "copy", of = "ball", clear_of = ["upper"], gap_mm = 10)") == Approx(0).margin(5));
  CHECK(volume(R"(kind = "ellipsoid", centre = [12, 0, 0], radii = [5, 5, 5], mirrored = true)") ==
        Approx(2 * shell(5, 0)).epsilon(0.02));
  CHECK(volume(R"(kind = "union", of = ["ball", "upper"])") == Approx(whole / 2 + 40 * 40 * 20).epsilon(0.005));

  const Case turned = make(R"({ name = "rod", label = "organ", frame = "tilted", kind = "tube", points = [
    [0, 0, 0, 3], [0, 0, 9, 3]] },)",
                           {}, R"(frames = [{ name = "tilted", at = [2, 0, 0], turn_deg = [0, 90, 0] }])");
  // Turned about y, what pointed to the head points to the left.
  CHECK(turned.labels.at({31, 20, 20}) == turned.find_label("organ")->value);
  CHECK(turned.labels.at({31, 20, 28}) != turned.find_label("organ")->value);
}

TEST_CASE("a later shape displaces an earlier one, and shares an edge voxel with it") {
  const Case subject =
      make(R"({ name = "lower", label = "organ", kind = "half_space", point = [0, 0, 0.25], normal = [0, 0, 1] },)");
  // The plane lies a quarter of a voxel into the layer from z = 0 to 1 (k = 20).
  CHECK(subject.ct.at({5, 5, 19}) == 60);
  CHECK(subject.ct.at({5, 5, 20}) == std::lround(-100 + 0.25 * 160));
  CHECK(subject.ct.at({5, 5, 21}) == -100);
  CHECK(subject.labels.at({5, 5, 19}) == subject.find_label("organ")->value);
  CHECK(subject.labels.at({5, 5, 20}) == subject.find_label("fat")->value);
}

TEST_CASE("options set numbers and switch shapes") {
  const std::string shapes = R"toml({ name = "ball", label = "organ", kind = "ellipsoid", centre = [0, 0, 0], radii = [
      "size_mm", "size_mm * 2 - size_mm", "max(size_mm, 2)"] },
    { name = "more", label = "rough", when = "extra", kind = "ellipsoid", centre = [0, 0, 0], radii = [3, 3, 3] },)toml";
  CHECK(volume_by_hu(make(shapes), 60) == Approx(4 / 3.0 * kPi * 1000).epsilon(0.005));
  CHECK(volume_by_hu(make(shapes, {{"size_mm", "5"}}), 60) == Approx(4 / 3.0 * kPi * 125).epsilon(0.02));
  CHECK(count(make(shapes), "rough") == 0);
  CHECK(count(make(shapes, {{"extra", "true"}}), "rough") > 90);
}

TEST_CASE("the same recipe gives the same bits with one, two and five threads") {
  const std::string shapes =
      R"({ name = "a", label = "rough", kind = "ellipsoid", centre = [1, 2, 3], radii = [14, 12, 13], uneven_mm = 1, uneven_grain_mm = 6 },
    { name = "b", label = "organ", kind = "tube", points = [[-15, 0, 0, 3], [0, 9, 2, 4], [15, 0, -5, 2]], clear_of = ["a"], gap_mm = 1 },)";
  const auto with_threads = [&](int threads) {
    // More of them than the machine has cores, too.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    tbb::task_arena arena(threads);
    return arena.execute([&] { return make(shapes); });
  };
  const Case one = with_threads(1);
  for (const int threads : {2, 5}) {
    const Case several = with_threads(threads);
    CHECK((several.ct.voxels == one.ct.voxels));
    CHECK((several.labels.voxels == one.labels.voxels));
  }

  std::string reseeded = small_recipe(shapes);
  reseeded.replace(reseeded.find("seed = 7"), 8, "seed = 8");
  CHECK(make_phantom("test.toml", reseeded).ct.voxels != one.ct.voxels);
}

TEST_CASE("a shape added to a recipe leaves the others as they were") {
  const std::string rough =
      R"({ name = "a", label = "organ", kind = "ellipsoid", centre = [1, 2, 3], radii = [14, 12, 13], uneven_mm = 1, uneven_grain_mm = 6 },)";
  const std::string other =
      R"({ name = "b", kind = "ellipsoid", centre = [0, 0, 0], radii = [3, 3, 3], uneven_mm = 1, uneven_grain_mm = 6 },)";
  const Case alone = make(rough), behind = make(other + rough);
  CHECK((alone.ct.voxels == behind.ct.voxels));
}

TEST_CASE("a tree of a recipe branches into its organ, in one thread or several") {
  const std::string grown =
      R"({ name = "organ", label = "organ", kind = "ellipsoid", centre = [0, 0, 0], radii = [18, 18, 18] },
    { name = "hole", kind = "ellipsoid", centre = [9, 0, 6], radii = [5, 5, 5] },
    { name = "stem", kind = "tube", points = [[0, 0, -19, 2.4], [0, 0, 2, 1.6]] },
    { name = "stem_alone", label = "rough", kind = "copy", of = "stem", when = "extra" },
    { name = "grown", KIND label = "rough" },)";
  const auto with = [&](const std::string& kind) {
    std::string text = grown;
    return text.replace(text.find("KIND"), 4, kind);
  };
  const std::string tree =
      R"(kind = "tree", stems = ["stem"], within = "organ", avoid = ["hole"], avoid_mm = 1.5, tips = 25, tip_mm = 1,)";
  const Case bare = make(with(R"(kind = "copy", of = "stem",)")), branched = make(with(tree));
  CHECK(count(branched, "rough") > 2 * count(bare, "rough"));
  const std::uint8_t vessel = branched.find_label("rough")->value;
  for (int k = 0; k < 40; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i) {
        if (branched.labels.at({i, j, k}) != vessel) continue;
        const glm::dvec3 p = branched.labels.grid.patient_from_index(glm::dvec3(i, j, k));
        CHECK(glm::length(p - glm::dvec3(9, 0, 6)) > 5);
        CHECK((glm::length(p) < 18 || p.z < -15));  // but for the stem's root
      }
  const std::string beside = R"(kind = "companion", of = "stem", share = 0.5, least_mm = 0.5, towards = [1, 0, 0],)";
  const Case accompanied = make(with(beside));
  CHECK(count(accompanied, "rough") > 20);
  CHECK(count(accompanied, "rough") < count(bare, "rough"));
}

TEST_CASE("a tube may be flattened in one place more than in another") {
  const Case subject = make(
      R"({ name = "made", label = "organ", kind = "tube", flat_towards = [0, 500, 0], points = [[0, 0, -30, 8, 0.5], [0, 0, 30, 8, 1]] },)");
  const auto extent = [&](int k, const glm::ivec3& step) {
    int n = 0;
    for (glm::ivec3 at(20, 20, k); subject.labels.at(at) == subject.find_label("organ")->value; at += step) ++n;
    return n;
  };
  CHECK(extent(0, {1, 0, 0}) == 8);
  CHECK(extent(39, {1, 0, 0}) == 8);
  CHECK(extent(0, {0, 1, 0}) < 6);  // of 8 mm, two thirds at a sixth of the way
  CHECK(extent(39, {0, 1, 0}) > 6);
}

TEST_CASE("texture has no mean, unit deviation, and nothing finer than its grain") {
  const Texture texture(3, 4.0f);
  double sum = 0, squares = 0, step_squares = 0;
  int samples = 0;
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 60; ++i) {
        const glm::vec3 p(float(i) * 1.37f, float(j) * 1.73f, float(k) * 1.19f);
        const double value = texture.at(p), step = texture.at(p + glm::vec3(0.2f, 0, 0)) - value;
        sum += value;
        squares += value * value;
        step_squares += step * step;
        ++samples;
      }
  CHECK(std::abs(sum / samples) < 0.05);  // about 2e5 / 4^3 independent grains: 0.02 standard errors
  CHECK(std::sqrt(squares / samples) == Approx(1).margin(0.1));
  // A twentieth of the grain moves it by little: a wave of one grain would give 2 pi / 20 = 0.31.
  CHECK(std::sqrt(step_squares / samples) < 0.31);
  CHECK(texture.at({1, 2, 3}) == texture.at({1, 2, 3}));
  CHECK(texture.at({1, 2, 3}) != Texture(4, 4.0f).at({1, 2, 3}));
}

TEST_CASE("texture and tubes are the same to the bit, at a point alone and among others") {
  std::vector<float> x, y, z;
  for (int n = 0; n < 203; ++n) {  // no multiple of what a processor takes at once
    x.push_back(float(n % 7) * 1.3f - 4.0f);
    y.push_back(float(n % 11) * 0.9f - 5.0f);
    z.push_back(float(n % 13) * 0.7f - 4.0f);
  }
  const Points points(x, y, z);
  const Texture texture(3, 2.0f);
  std::vector<std::size_t> odd;
  for (std::size_t n = 1; n < points.count(); n += 2) odd.push_back(n);
  const std::vector<float> values = texture.at(points, odd);
  REQUIRE(values.size() == odd.size());
  for (std::size_t n = 0; n < odd.size(); ++n) CHECK(values[n] == texture.at({x[odd[n]], y[odd[n]], z[odd[n]]}));

  const std::vector<TubePoint> bent{{{-9, -3, 0}, 2}, {{0, 4, 1}, 3}, {{8, -2, -3}, 1.5f}};
  TubeForm flat;
  flat.flatness = 0.6f;
  flat.flat_towards = {0, 100, 0};
  for (const TubeForm& form : {TubeForm(), flat}) {
    const ShapePtr tube = make_tube(bent, form);
    Points block(x, y, z);
    const std::vector<float>& together = block.distances_to(*tube);
    for (std::size_t n = 0; n < points.count(); ++n) {
      Points alone({x[n]}, {y[n]}, {z[n]});
      CHECK(together[n] == alone.distances_to(*tube)[0]);
    }
  }
}

TEST_CASE("progress rises to one, in at most a hundred calls") {
  std::vector<double> shares;
  make_phantom("test.toml", small_recipe(""), {}, [&](double share) { shares.push_back(share); });
  REQUIRE_FALSE(shares.empty());
  CHECK(shares.size() <= 100);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.back() == 1.0);
}

TEST_CASE("arithmetic follows the rules of school and says what is wrong") {
  const std::map<std::string, double> values{{"a", 3}, {"b_2", 4}};
  const auto value = [&](const char* text) {
    return evaluate_arithmetic(text, values).value.value_or(std::numeric_limits<double>::quiet_NaN());
  };
  CHECK(value("1 + 2 * 3") == 7);
  CHECK(value("(1 + 2) * 3") == 9);
  CHECK(value("8 - 4 - 2") == 2);
  CHECK(value("8 / 4 / 2") == 1);
  CHECK(value("-a + b_2") == 1);
  CHECK(value("min(a, b_2) - max(a, 5)") == -2);
  CHECK(value("1.5e1") == 15);
  for (const char* wrong : {"", "1 +", "(1", "1)", "1 / 0", "min(1)", "1 2", "*", "1e999", "a b"}) {
    INFO(wrong);
    const ArithmeticResult result = evaluate_arithmetic(wrong, values);
    CHECK_FALSE(result.value);
    CHECK_FALSE(result.problem.empty());
  }
  CHECK(evaluate_arithmetic("a + c", values).unknown_name == "c");
  CHECK_FALSE(evaluate_arithmetic(std::string(100000, '('), values).value);
  CHECK_FALSE(evaluate_arithmetic(std::string(100000, '-') + "1", values).value);
}

namespace {

std::string refusal(const std::string& text, const Options& options = {}) {
  try {
    make_phantom("test.toml", text, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a recipe that cannot be used is refused with its line and a way out") {
  const std::string ball =
      R"({ name = "ball", label = "organ", kind = "ellipsoid", centre = [0, 0, 0], radii = [9, 9, 9] },)";
  const std::string view = R"(views = [{ name = "v", title = "V", probe = "curvilinear", )";
  const std::string point = R"(landmarks = [{ name = "p", at = [0, 0, 0] }]
)";
  const std::string stem = R"({ name = "stem", kind = "tube", points = [[0, 0, 0, 1], [0, 0, 9, 1]] },
    { name = "h", kind = "half_space", point = [0, 0, 0], normal = [0, 0, 1] }, )";
  const auto changed = [](const std::string& what, const std::string& by) {
    std::string text = small_recipe("");
    return text.replace(text.find(what), what.size(), by);
  };
  std::string more_labels;
  for (int n = 0; n < 253; ++n)
    more_labels += "  { name = \"l" + std::to_string(n) + "\", tissue = \"fat\", hu = 1 },\n";
  std::string no_labels = small_recipe("");
  no_labels.erase(no_labels.find("labels = ["), no_labels.find("shapes = [") - no_labels.find("labels = ["));
  struct Bad {
    std::string text;
    std::vector<std::string> said;  // what the sentence has to hold
  };
  const std::vector<Bad> table{
      {"name = ", {"line 1", "TOML"}},
      {"", {"'name' is missing"}},
      {"name = \"x\"\n", {"the key 'grid' is missing; add it: [grid]"}},
      {"name = \"x\"\noptions = 3\n", {"line 2", "'options' is not a table; write [options]"}},
      {"name = \"x\"\noptions.size_mm = 3\n", {"line 2", "'size_mm' is not a table; write [options.size_mm]"}},
      {"name = \"x\"\noptions.size_mm = { default = 3, about = \"a radius\" }\n",
       {"line 2", "option 'size_mm'", "the key 'least' is missing; add it: a number from"}},
      {small_recipe("") + "colour = 1\n", {"line 15", "'colour' is unknown"}},
      {small_recipe(R"({ kind = "ellipsoid" },)"), {"line 13", "'name' is missing"}},
      {small_recipe(R"({ name = "a" },)"), {"line 13", "shape 'a'", "'kind' is missing"}},
      {small_recipe(R"({ name = "A b", kind = "box" },)"), {"line 13", "lower-case"}},
      {small_recipe(R"({ name = "a", kind = "elipsoid" },)"), {"line 13", "did you mean 'ellipsoid'"}},
      {small_recipe(R"({ name = "a", kind = "ellipsoid", centre = 3, radii = [1, 1, 1] },)"),
       {"line 13", "shape 'a'", "'centre' is not a list; write 3 numbers"}},
      {small_recipe(R"({ name = "a", kind = "ellipsoid", centre = [0, 0], radii = [1, 1, 1] },)"),
       {"'centre' has 2 numbers"}},
      {small_recipe(R"({ name = "a", kind = "ellipsoid", centre = [0, 0, 0], radii = [1, 0, 1] },)"),
       {"line 13", "'radii' holds 0"}},
      {small_recipe(R"({ name = "a", kind = "ellipsoid", centre = [0, 0, nan], radii = [1, 1, 1] },)"), {"'centre'"}},
      {small_recipe(R"({ name = "a", kind = "ellipsoid", centre = [0, 0, true], radii = [1, 1, 1] },)"),
       {"not a number"}},
      {small_recipe(R"({ name = "a", kind = "ellipsoid", centre = [0, 0, "siz_mm"], radii = [1, 1, 1] },)"),
       {"did you mean 'size_mm'"}},
      {small_recipe(R"({ name = "a", kind = "ellipsoid", centre = [0, 0, "1 +"], radii = [1, 1, 1] },)"),
       {"cannot be evaluated"}},
      {small_recipe(R"({ name = "a", kind = "ellipsoid", centre = [0, 0, 0], radius = [1, 1, 1] },)"),
       {"'radii' is missing"}},
      {small_recipe(R"({ name = "a", kind = "box", centre = [0, 0, 0], half_sizes = [1, 1, 1], roundin_mm = 1 },)"),
       {"did you mean 'rounding_mm'"}},
      {small_recipe(R"({ name = "all", kind = "box", centre = [0, 0, 0], half_sizes = [1, 1, 1] },)"),
       {"another shape 'all'"}},
      {small_recipe(R"({ name = "a", kind = "copy", of = "al" },)"), {"did you mean 'all'"}},
      {small_recipe(R"({ name = "a", kind = "copy", of = "a" },)"), {"no shape 'a' above"}},
      {small_recipe(R"({ name = "a", kind = "union", of = [] },)"), {"names no shape"}},
      {small_recipe(R"({ name = "a", kind = "copy", of = "all", label = "orgn" },)"), {"did you mean 'organ'"}},
      {small_recipe(R"({ name = "a", kind = "copy", of = "all", frame = "f" },)"), {"no frame 'f'"}},
      {small_recipe(R"({ name = "a", kind = "copy", of = "all", when = "extr" },)"), {"did you mean 'extra'"}},
      {small_recipe(R"({ name = "a", kind = "tube", points = [[0, 0, 0, 1]] },)"), {"'points' has 1 rows"}},
      {small_recipe(R"({ name = "a", kind = "tube", points = [[0, 0, 0], [0, 0, 1]] },)"),
       {"a row that is not a list of 4 to 5 numbers"}},
      {small_recipe(R"({ name = "a", kind = "tube", points = [[0, 0, 0, 0], [0, 0, 1, 1]] },)"), {"radius"}},
      {small_recipe(R"({ name = "a", kind = "loft", sections = [[1, 0, 0, 1, 1, 1], [0, 0, 0, 1, 1, 1]] },)"),
       {"z does not rise"}},
      {small_recipe(R"({ name = "a", kind = "rib", on = "all", radius_mm = 3, stations = [[0, 0], [9, 9]] },)"),
       {"no loft 'all'"}},
      {small_recipe(R"({ name = "a", kind = "half_space", point = [0, 0, 0], normal = [0, 0, 0] },)"), {"no length"}},
      {small_recipe(R"({ name = "a", kind = "tube", points = [[0, 0, 0, 1, 2], [0, 0, 1, 1]] },)"), {"flatness is 2"}},
      {small_recipe(R"({ name = "a", kind = "tube", points = [[0, 0, 0, 1, 0.5], [0, 0, 1, 1]] },)"),
       {"'flat_towards' is missing"}},
      {small_recipe(R"({ name = "a", kind = "tree", stems = ["s"], within = "all", tips = 3, tip_mm = 1 },)"),
       {"line 13", "no tube, tree or companion 's' above"}},
      {small_recipe(stem + R"({ name = "a", kind = "tree", stems = ["stem"], within = "al", tips = 3, tip_mm = 1 },)"),
       {"did you mean 'all'"}},
      {small_recipe(stem + R"({ name = "a", kind = "tree", stems = ["stem"], within = "h", tips = 3, tip_mm = 1 },)"),
       {"'within' names has no end"}},
      {small_recipe(stem + R"({ name = "a", kind = "tree", stems = ["stem"], within = "all", tips = 0, tip_mm = 1 },)"),
       {"'tips' is 0"}},
      {small_recipe(stem +
                    R"({ name = "a", kind = "companion", of = "stm", share = 1, least_mm = 1, towards = [1, 0, 0] },)"),
       {"did you mean 'stem'"}},
      {small_recipe(
           R"({ name = "a", kind = "spokes", centre = [0, 0, 0], inner = [1, 1, 1], outer = [2, 2, 2], count = 0 },)"),
       {"'count' is 0"}},
      {small_recipe(
           stem +
           R"({ name = "thin", kind = "companion", of = "stem", share = 0.1, least_mm = 1, towards = [1, 0, 0] },
    { name = "a", kind = "tree", stems = ["thin"], within = "all", tips = 3, tip_mm = 1 },)"),
       {"no stem has a line"}},
      {small_recipe(
           stem +
           R"({ name = "thin", kind = "companion", of = "stem", share = 0.1, least_mm = 1, towards = [1, 0, 0] },
    { name = "a", kind = "copy", of = "all", label = "fat", septa = { hu = 9, apart_mm = 2, along_mm = 9, along = "thin" } },)"),
       {"'thin' is not one line"}},
      {small_recipe(
           R"({ name = "a", kind = "copy", of = "all", label = "fat", septa = { hu = 9, apart_mm = 2, along_mm = 9 } },)"),
       {"shape 'a', its septa", "'along' is missing"}},
      {small_recipe(
           R"({ name = "a", kind = "copy", of = "all", label = "fat", septa = { hu = 9, apart_mm = 2, along_mm = 9, layers_of = "alll" } },)"),
       {"did you mean 'all'"}},
      {small_recipe(
           R"({ name = "a", kind = "copy", of = "all", septa = { hu = 9, apart_mm = 2, along_mm = 9, layers_of = "all" } },)"),
       {"'septa' is unknown"}},
      {small_recipe(R"({ name = "a", kind = "shell", of = "all", inner_mm = 2, outer_mm = 1 },)"), {"'outer_mm' is 1"}},
      {small_recipe(R"({ name = "a", kind = "loft", sections = [[0, 0, 0, 1, 0.1, 1], [1, 0, 0, 1, 1, 1]] },)"),
       {"line 13", "a section's half width, front or back is below 0.2 mm; make it wider"}},
      {no_labels, {"there are no labels; list at least one"}},
      {changed("name = \"organ\"", "name = \"fat\""), {"line 8", "there are two labels 'fat'; rename one"}},
      {changed("labels = [\n", "labels = [\n" + more_labels),
       {"line 262", "there are more than 255 labels; join some"}},
      {changed(", label = \"fat\"", ""), {"no shape has a label, so nothing would be drawn; add a shape"}},
      {small_recipe("", "landmarks = [{ name = \"p\", at = [0, 0, 0] }, { name = \"p\", at = [1, 0, 0] }]\n"),
       {"line 15", "there are two landmarks 'p'; rename one"}},
      {small_recipe("", point + view + "aim = \"p\", from = [9, 0, 0], marker = [0, 1, 0] },\n" + view.substr(9) +
                            "aim = \"p\", from = [9, 0, 0], marker = [0, 1, 0] }]\n"),
       {"line 17", "there are two views 'v'; rename one"}},
      {small_recipe("", "frames = [{ name = \"f\", at = [0, 0, 0] }, { name = \"f\", at = [0, 0, 0] }]\n"),
       {"two frames 'f'"}},
      {small_recipe("", "landmarks = 3\n"), {"not a list of tables"}},
      {small_recipe("", point + view + "aim = \"q\", from = [0, 0, 9], marker = [1, 0, 0] }]\n"), {"no landmark 'q'"}},
      {small_recipe("", point + view + "aim = \"p\", from = [0, 0, 0], marker = [1, 0, 0] }]\n"),
       {"looks from where it aims"}},
      {small_recipe("", point + view + "aim = \"p\", from = [9, 0, 0], marker = [1, 0, 0] }]\n"), {"along the beam"}},
      {small_recipe("", point + view + "aim = \"p\", from = [9, 0, 0], marker = [0, 1, 0], targets = [\"orga\"] }]\n"),
       {"did you mean 'organ'"}},
      {small_recipe("", point + view + "aim = [0, 0, 500], from = [0, 0, 900], marker = [0, 1, 0] }]\n"),
       {"view 'v'", "under the skin"}},
  };
  for (const Bad& bad : table) {
    const std::string said = refusal(bad.text);
    INFO(bad.text.substr(bad.text.size() > 160 ? bad.text.size() - 160 : 0) << "\n-> " << said);
    CHECK(said.find("test.toml") == 0);
    for (const std::string& part : bad.said) CHECK(said.find(part) != std::string::npos);
  }
  CHECK(refusal(small_recipe(ball)).empty());
  CHECK(refusal(small_recipe(ball, point + view + "aim = \"p\", from = [9, 0, 0], marker = [0, 1, 0] }]\n")).empty());
}

TEST_CASE("an absurd grid and a wrong option are refused") {
  const auto with_grid = [](const std::string& grid) {
    std::string text = small_recipe("");
    const std::size_t begin = text.find("grid = "), end = text.find('\n', begin);
    return text.replace(begin, end - begin, "grid = " + grid);
  };
  CHECK(refusal(with_grid("{ from = [0, 0, 0], to = [900, 900, 900], voxel_mm = 0.3 }")).find("3000 voxels") !=
        std::string::npos);
  CHECK(refusal(with_grid("{ from = [0, 0, 0], to = [-9, 9, 9], voxel_mm = 1 }")).find("voxels along axis 0") !=
        std::string::npos);
  CHECK(refusal(with_grid("{ from = [0, 0, 0], to = [9, 9, 9], voxel_mm = 0 }")).find("'voxel_mm' is 0") !=
        std::string::npos);
  CHECK(refusal(with_grid("{ from = [0, 0, 0], to = [600, 600, 600], voxel_mm = 0.3 }")).find("voxels") !=
        std::string::npos);
  CHECK(refusal(small_recipe(""), {{"sise_mm", "3"}}).find("did you mean 'size_mm'") != std::string::npos);
  CHECK(refusal(small_recipe(""), {{"size_mm", "99"}}).find("from 1 to 15") != std::string::npos);
  CHECK(refusal(small_recipe(""), {{"size_mm", "3mm"}}).find("not a number") != std::string::npos);
  CHECK(refusal(small_recipe(""), {{"size_mm", "nan"}}).find("not a number") != std::string::npos);
  CHECK(refusal(small_recipe(""), {{"extra", "yes"}}).find("neither true nor false") != std::string::npos);
}
