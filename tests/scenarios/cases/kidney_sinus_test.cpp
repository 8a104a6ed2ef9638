#include "scenarios/cases/kidney_sinus.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

using namespace insonate;
using Catch::Contains;

namespace {

constexpr std::uint8_t kKidney = 3;

/// A kidney: an ellipsoid around fat that opens to the patient's left, 20 mm wide. In voxels of 2 mm.
Case kidney(double opening_mm) {
  Case subject;
  subject.ct.grid.size = {50, 50, 70};
  subject.ct.grid.spacing = glm::dvec3(2);
  subject.label_table = {{kKidney, "kidney_right", "kidney_cortex"}};
  for (int z = 0; z < 70; ++z)
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 50; ++x) {
        const glm::dvec3 p = 2.0 * (glm::dvec3(x, y, z) - glm::dvec3(25, 25, 35));
        const bool inside = glm::length(p / glm::dvec3(25, 25, 50)) < 1;
        const bool fat = glm::length(p / glm::dvec3(14, 10, 25)) < 1 ||
                         (p.x > 0 && std::max(std::abs(p.y), std::abs(p.z)) < opening_mm / 2);
        subject.ct.voxels.push_back(inside && !fat ? 30 : -90);
        subject.labels.voxels.push_back(inside && !fat ? kKidney : 0);
      }
  subject.labels.grid = subject.ct.grid;
  return subject;
}

double ml_of(const Case& subject, std::uint8_t value) {
  return double(std::ranges::count(subject.labels.voxels, value)) * 8 / 1000;
}

}  // namespace

TEST_CASE("what a kidney encloses without a label becomes its sinus, and nothing around it does") {
  Case subject = kidney(20);
  const Case before = subject;
  const std::vector<std::string> notes = label_kidney_sinuses(subject);
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes[0], Contains("'kidney_right_sinus'"));
  REQUIRE(subject.label_table.size() == 2);
  const Label& sinus = subject.label_table[0];
  CHECK(sinus.value == 1);  // the lowest that is free
  CHECK(sinus.name == "kidney_right_sinus");
  CHECK(sinus.tissue == "kidney_sinus");
  // The ellipsoid of 14.7 ml, and the opening's part in the kidney; less their edges where voxels are as thin as that.
  CHECK(ml_of(subject, sinus.value) == Approx(17).margin(2));
  CHECK(ml_of(subject, kKidney) == ml_of(before, kKidney));
  for (int z = 0; z < 70; ++z)
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 50; ++x) {
        const glm::dvec3 p = 2.0 * (glm::dvec3(x, y, z) - glm::dvec3(25, 25, 35));
        if (subject.labels.at({x, y, z}) == sinus.value && glm::length(p / glm::dvec3(25, 25, 50)) > 1.1)
          FAIL("at " << p.x << ", " << p.y << ", " << p.z);
      }
  // Once is enough.
  CHECK(label_kidney_sinuses(subject).empty());
  CHECK(subject.label_table.size() == 2);
}

TEST_CASE("gas and other structures are no sinus, nor is a dent, and without a kidney or a free value there is none") {
  Case with_others = kidney(20);
  std::uint8_t* stone = &with_others.labels.at({25, 25, 35});
  *stone = 9;
  with_others.label_table.push_back({9, "kidney_stone", "stone"});
  with_others.ct.at({25, 25, 40}) = -900;
  CHECK(label_kidney_sinuses(with_others).size() == 1);
  CHECK(*stone == 9);
  CHECK(with_others.labels.at({25, 25, 40}) == 0);

  Case solid = kidney(20);  // but for 1 ml under its surface
  for (int z = 0; z < 70; ++z)
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 50; ++x) {
        const glm::dvec3 p = 2.0 * (glm::dvec3(x, y, z) - glm::dvec3(25, 25, 35));
        if (glm::length(p / glm::dvec3(25, 25, 50)) < 1 && glm::length(p - glm::dvec3(22, 0, 0)) > 6)
          solid.labels.at({x, y, z}) = kKidney;
      }
  CHECK(label_kidney_sinuses(solid).empty());

  Case absent = kidney(20);
  absent.label_table[0].name = "liver";
  CHECK(label_kidney_sinuses(absent).empty());

  Case full = kidney(20);
  for (int value = 1; value < 256; ++value)
    if (value != kKidney)
      full.label_table.push_back({std::uint8_t(value), "part_" + std::to_string(value), "soft_tissue"});
  CHECK(label_kidney_sinuses(full).empty());
}
