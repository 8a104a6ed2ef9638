// I along lines through gas, bone, gel and curved surfaces, against what can be worked out by hand. How exactly the
// reference follows the model is tested in tests/accuracy. Tolerances are rounding's unless said otherwise.

#include <catch2/catch.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/reference/reference.h"
#include "tests/accuracy/media.h"

using namespace insonate;
using namespace insonate::test;

TEST_CASE("gas and bone cast the shadows that their impedances ask for") {
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Settings settings = without_absorption(0.6);
  const ScanLines lines = one_line(60, 600);
  const auto behind = [&](double hu) {
    const MediumField slab = [=](const glm::dvec3& p) { return Medium{p.y > 20.03 && p.y < 30.03 ? hu : 60, 0}; };
    return traverse_reference(slab, table, lines, settings, {}).intensity.at(0, lines.samples - 1);
  };
  CHECK(behind(60) == 1);
  CHECK(behind(1000) == Approx(std::pow(1 - std::pow((7.8 - 1.65) / (7.8 + 1.65), 2), 2)).epsilon(1e-9));
  CHECK(behind(-990) < 1.1e-6);  // (4 x 0.0004 x 1.65 / 1.65^2)^2
}

TEST_CASE("coupling gel takes the place of air in front of the skin, and of nothing else") {
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Settings settings = without_absorption(0.6);
  const ScanLines lines = one_line(60, 600);
  const auto at_depth = [&](double gap_mm, double gel_mm) {
    settings.gel_mm = gel_mm;
    const MediumField skin = [=](const glm::dvec3& p) { return Medium{p.y > gap_mm + 0.03 ? 60.0 : -1000.0, 0}; };
    return traverse_reference(skin, table, lines, settings, {}).intensity.at(0, lines.samples - 1);
  };
  CHECK(at_depth(4, 0) < 1e-5);
  CHECK(at_depth(4, 6) > 0.99);
  CHECK(at_depth(10, 6) < 1e-5);
}

TEST_CASE("gel that ends in air returns little, and gel that ends on skin or bone what they reflect") {
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Settings settings = without_absorption(0.6);
  settings.waves = true;
  settings.gel_mm = 6;
  const ScanLines lines = one_line(60, 600);
  // The greatest echo of an interface between two depths, mm.
  const auto greatest = [&](double gap_mm, double hu, double from_mm, double to_mm) {
    const MediumField body = [=](const glm::dvec3& p) { return Medium{p.y > gap_mm + 0.03 ? hu : -1000.0, 0}; };
    const ReferenceScan scan = traverse_reference(body, table, lines, settings, {});
    double most = 0;
    for (int k = int(10 * from_mm); k < int(10 * to_mm); ++k) most = std::max(most, scan.reflection.at(0, k));
    return most;
  };
  const auto reflected = [&](double one_hu, double other_hu) {
    const double a = table.at(one_hu).impedance_mrayl, b = table.at(other_hu).impedance_mrayl;
    return std::pow((a - b) / (a + b), 2);
  };
  CHECK(greatest(20, 60, 5, 7) == Approx(1e-3 * reflected(0, -1000)).epsilon(1e-6));
  CHECK(greatest(4, 1000, 3, 5) == Approx(reflected(0, 1000)).epsilon(1e-6));
  CHECK(greatest(6, 1000, 5, 7) == Approx(reflected(0, 1000)).epsilon(1e-6));  // where the gel's end is
  settings.gel_mm = 0;
  CHECK(greatest(20, 60, 0, 1) == Approx(reflected(0, -1000)).epsilon(1e-6));  // the face itself
  settings.gel_mm = 6;
  settings.waves = false;
  CHECK(greatest(20, 60, 5, 7) == Approx(reflected(0, -1000)).epsilon(1e-6));
}

TEST_CASE("air against the face lets pass what an interface of water and air does, however many samples meet it") {
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  const double water = table.at(0).impedance_mrayl, air = table.at(-1000).impedance_mrayl;
  const ScanLines lines = one_line(60, 600);
  const int samples_per_length = GENERATE(1, 2, 3, 8);
  CAPTURE(samples_per_length);
  Settings settings = without_absorption(samples_per_length * lines.dr_mm());
  settings.gel_mm = 0;
  const MediumField nothing = [](const glm::dvec3&) { return Medium{-1000, -60}; };
  const double behind = traverse_reference(nothing, table, lines, settings, {}).intensity.at(0, 20);
  CHECK(behind == Approx(4 * water * air / std::pow(water + air, 2)).epsilon(1e-9));
}

TEST_CASE("what is almost air turns into gel by degrees") {
  const auto coupled = [](double hu, double r_mm) { return with_gel({hu, -10}, r_mm, 2); };
  for (const auto& [hu, share] : {std::pair{60.0, 0.0}, {-150.0, 0.0}, {-225.5, 0.5}, {-301.0, 1.0}, {-1000.0, 1.0}}) {
    CHECK(coupled(hu, 1.99).hu == Approx((1 - share) * hu));
    CHECK(coupled(hu, 1.99).echogenicity_db == Approx(-10 - 50 * share));
    CHECK(coupled(hu, 2).hu == hu);
    CHECK(coupled(hu, 2).echogenicity_db == -10);
  }
}

TEST_CASE("sound that grazes the limb of a cyst is lost, sound that meets an interface plainly is not") {
  const TissueTable table{{{-1000, 1.0, 0, 0}, {1000, 1.0, 0, 0}}, {}};  // nothing reflects
  Settings settings = without_absorption(0.6);
  settings.edge_shadow = true;
  const auto left_behind = [&](const MediumField& field, double x) {
    ScanLines lines = one_line(80, 1600);
    lines.lines.front().start.x = x;
    return traverse_reference(field, table, lines, settings, {}).intensity.at(0, lines.samples - 1);
  };
  // A plane turns the sound by ln(1595 / 1450) tan(tilt); q is that in units of 0.1 rad to the power of four, and the
  // loss the root of 1 + q/2 where the interface is thin beside 5 mm; at 60 degrees it takes up 0.3 mm.
  settings.reflection_length_mm = 0.1;
  for (double tilt : {0.0, 30.0, 45.0, 60.0}) {
    const double turn = std::log(1595.0 / 1450) * std::tan(glm::radians(tilt));
    const double lost = std::log(1 + std::pow(turn / 0.1, 4) / 2) / 2;
    INFO(tilt << " degrees");
    CHECK(-std::log(left_behind(interface_at(30, -100, 60, tilt, 0.05), 0)) == Approx(lost).epsilon(0.15).margin(1e-9));
  }
  settings.reflection_length_mm = 0.6;
  // A cyst of water in liver, radius 15 mm, as blurred as a CT is.
  const MediumField cyst = [](const glm::dvec3& p) {
    const double inside = 15 - std::hypot(p.x, p.y - 40);
    return Medium{60 - 60 * std::clamp(inside / 1.2 + 0.5, 0.0, 1.0), 0};
  };
  CHECK(left_behind(cyst, 0) > 0.9999);
  CHECK(left_behind(cyst, 7.5) > 0.995);
  CHECK(left_behind(cyst, 17) > 0.9999);
  CHECK(left_behind(cyst, 15) < 0.7);
  CHECK(left_behind(cyst, -15) == Approx(left_behind(cyst, 15)));
  settings.edge_shadow = false;
  CHECK(left_behind(cyst, 15) == 1);
}
