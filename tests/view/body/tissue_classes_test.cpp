#include "sim/view/body/tissue_classes.h"

#include <catch2/catch.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

using namespace insonate;
using view::TissueClasses;

namespace {

constexpr int kSide = 90;

/// A body of fat with gas, a bone and a labelled organ inside, and a table of wood under it; 1 mm voxels.
struct Patient {
  Volume<std::int16_t> ct;
  Volume<std::uint8_t> labels;
  view::OrganColours colours{};

  Patient() {
    ct.grid.size = glm::ivec3(kSide);
    ct.grid.spacing = glm::dvec3(1.0);
    labels.grid = ct.grid;
    for (int k = 0; k < kSide; ++k)
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
          const glm::dvec3 p(i, j, k);
          int hu = -1000, label = 0;
          if (std::hypot(i - 45, j - 40) < 34) hu = -100;
          if (glm::distance(p, {45, 30, 45}) < 9) hu = -1000;
          if (glm::distance(p, {30, 45, 40}) < 7) hu = 700;
          if (glm::distance(p, {60, 45, 50}) < 10) label = 7;
          if (j > 80 && j < 86) hu = 250;
          ct.voxels.push_back(std::int16_t(hu));
          labels.voxels.push_back(std::uint8_t(label));
        }
    colours[7] = {{0.2f, 0.4f, 0.6f}, 0.5f};
  }
};

std::size_t at_mm(const TissueClasses& classes, const glm::ivec3& mm) {
  const glm::ivec3 v = mm / classes.step;
  return (std::size_t(v.z) * std::size_t(classes.size.y) + std::size_t(v.y)) * std::size_t(classes.size.x) +
         std::size_t(v.x);
}

}  // namespace

TEST_CASE("a body is solid, with its gas, and without the table it lies on") {
  const Patient patient;
  const TissueClasses classes = classify_tissue(patient.ct, patient.labels, patient.colours);
  REQUIRE(classes.step == glm::ivec3(2));
  CHECK(classes.body[at_mm(classes, {45, 60, 45})][1] == 255);  // fat
  CHECK(classes.body[at_mm(classes, {45, 30, 45})][1] == 255);  // gas
  CHECK(classes.body[at_mm(classes, {2, 2, 45})][1] == 0);      // air
  CHECK(classes.body[at_mm(classes, {45, 83, 45})][1] == 0);    // table
  CHECK(classes.tissue[at_mm(classes, {45, 83, 45})][3] == 0);
}

TEST_CASE("a thin sheet that touches the body is left out but for its rim, and the body stays whole") {
  Patient patient;
  const TissueClasses before = classify_tissue(patient.ct, patient.labels, patient.colours);
  const auto is_sheet = [](const glm::ivec3& v) { return v.y >= 50 && v.y < 54; };  // two voxels of the classes
  for (int z = 0; z < patient.ct.grid.size.z; ++z)
    for (int y = 0; y < patient.ct.grid.size.y; ++y)
      for (int x = 0; x < patient.ct.grid.size.x; ++x)
        if (std::int16_t& hu = patient.ct.voxels[patient.ct.grid.offset({x, y, z})]; is_sheet({x, y, z}))
          hu = std::max<std::int16_t>(hu, -50);
  const TissueClasses classes = classify_tissue(patient.ct, patient.labels, patient.colours);
  CHECK(classes.body[at_mm(classes, {3, 52, 45})][1] == 0);  // far out on the sheet
  int changed = 0;
  for (int z = 6; z < 84; z += 2)
    for (int y = 6; y < 84; y += 2)
      for (int x = 6; x < 84; x += 2)
        if (before.body[at_mm(before, {x, y, z})][1] == 255)
          changed += classes.body[at_mm(classes, {x, y, z})][1] != 255;
  CHECK(changed == 0);
}

TEST_CASE("organs come from labels and bone from its density") {
  const Patient patient;
  const TissueClasses classes = classify_tissue(patient.ct, patient.labels, patient.colours);
  const auto organ = classes.tissue[at_mm(classes, {60, 45, 50})];
  CHECK(organ == std::array<std::uint8_t, 4>{51, 102, 153, 255});
  CHECK(int(classes.body[at_mm(classes, {60, 45, 50})][0]) == Approx(127.5).margin(1));
  CHECK(classes.tissue[at_mm(classes, {30, 45, 40})][3] == 255);
  CHECK(classes.tissue[at_mm(classes, {45, 60, 45})][3] == 0);

  const TissueClasses without_labels = classify_tissue(patient.ct, {}, patient.colours);
  CHECK(without_labels.tissue[at_mm(without_labels, {60, 45, 50})][3] == 0);
  CHECK(without_labels.tissue[at_mm(without_labels, {30, 45, 40})][3] == 255);
}

TEST_CASE("every leap is as far as nothing changes and no farther") {
  const Patient patient;
  const TissueClasses classes = classify_tissue(patient.ct, patient.labels, patient.colours);
  const glm::ivec3 blocks = classes.blocks;
  const auto distance = [&](const glm::ivec3& b) {
    return int(classes.distance[(std::size_t(b.z) * std::size_t(blocks.y) + std::size_t(b.y)) * std::size_t(blocks.x) +
                                std::size_t(b.x)]);
  };
  // Busy from the definition: a sample in the block, which sees one voxel beyond it, can find tissue or a change.
  std::vector<glm::ivec3> busy;
  int wrong = 0;
  const auto for_each_block = [&](auto visit) {
    for (int z = 0; z < blocks.z; ++z)
      for (int y = 0; y < blocks.y; ++y)
        for (int x = 0; x < blocks.x; ++x) visit(glm::ivec3(x, y, z));
  };
  for_each_block([&](const glm::ivec3& b) {
    int least = 255, most = 0, opacity = 0;
    for (int z = -1; z <= TissueClasses::kBlock; ++z)
      for (int y = -1; y <= TissueClasses::kBlock; ++y)
        for (int x = -1; x <= TissueClasses::kBlock; ++x) {
          const glm::ivec3 v =
              glm::clamp(b * TissueClasses::kBlock + glm::ivec3(x, y, z), glm::ivec3(0), classes.size - 1);
          const auto& [solid, body] = classes.body[at_mm(classes, v * classes.step)];
          least = std::min<int>(least, body);
          most = std::max<int>(most, body);
          opacity = std::max<int>(opacity, solid);
        }
    const bool is_busy = opacity > 0 || least != most;
    if (is_busy) busy.push_back(b);
    wrong += is_busy != (distance(b) == 0);
  });
  CHECK(wrong == 0);
  REQUIRE(!busy.empty());

  int checked = 0;
  for_each_block([&](const glm::ivec3& b) {
    if ((b.x + 3 * b.y + 5 * b.z) % 17) return;
    int nearest = 255;
    for (const glm::ivec3& other : busy) {
      const glm::ivec3 away = glm::abs(other - b);
      nearest = std::min({nearest, std::max({away.x, away.y, away.z})});
    }
    wrong += distance(b) != nearest;
    ++checked;
  });
  CHECK(wrong == 0);
  CHECK(checked > 500);
}
