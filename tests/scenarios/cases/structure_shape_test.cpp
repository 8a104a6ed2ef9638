// Axes, ends and contacts of solids whose own are known.

#include "scenarios/cases/structure_shape.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <functional>

#include "scenarios/cases/anatomy.h"

using namespace insonate;

namespace {

Case labelled(const Grid& grid, const std::vector<Label>& table, const std::function<int(const glm::dvec3&)>& at) {
  Case subject;
  subject.ct.grid = subject.labels.grid = grid;
  subject.ct.voxels.assign(grid.count(), 40);
  subject.labels.voxels.resize(grid.count());
  subject.label_table = table;
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i)
        subject.labels.at({i, j, k}) = std::uint8_t(at(grid.patient_from_index({i, j, k})));
  return subject;
}

Grid cube_grid(int side, double voxel_mm) {
  Grid grid;
  grid.size = glm::ivec3(side);
  grid.spacing = glm::dvec3(voxel_mm);
  grid.origin = glm::dvec3(-(side - 1) / 2.0 * voxel_mm);
  return grid;
}

}  // namespace

TEST_CASE("the axes of a box are its edges, and its deviations their lengths over the root of 12") {
  // 20 x 6 x 10 voxels of 1 x 2 x 3 mm make a box of 20 x 12 x 30 mm, whatever the grid's own rotation.
  Grid grid;
  grid.size = {30, 16, 20};
  grid.spacing = {1, 2, 3};
  grid.origin = {5, 6, 7};
  grid.direction = glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(20.0), glm::dvec3(0, 1, 0)));
  Case subject = labelled(grid, {{4, "box", "liver"}}, [](const glm::dvec3&) { return 0; });
  for (int k = 5; k < 15; ++k)
    for (int j = 4; j < 10; ++j)
      for (int i = 3; i < 23; ++i) subject.labels.at({i, j, k}) = 4;
  const auto shapes = structure_shapes(subject);
  REQUIRE(shapes.size() == 1);
  const StructureShape& box = shapes[0];
  CHECK(box.voxels == 1200);
  CHECK_FALSE(box.cut);
  const glm::dvec3 middle = grid.patient_from_index({12.5, 6.5, 9.5});
  CHECK(glm::distance(box.centroid, middle) < 1e-9);
  CHECK(glm::distance(box.centre, middle) < 1e-9);
  CHECK(box.deviation_mm[0] == Approx(30 / std::sqrt(12.0)));
  CHECK(box.deviation_mm[1] == Approx(20 / std::sqrt(12.0)));
  CHECK(box.deviation_mm[2] == Approx(12 / std::sqrt(12.0)));
  // To the head, to the right and to the front: along k, against i and against j.
  CHECK(glm::distance(box.axes[0], grid.direction[2]) < 1e-9);
  CHECK(glm::distance(box.axes[1], -grid.direction[0]) < 1e-9);
  CHECK(glm::distance(box.axes[2], -grid.direction[1]) < 1e-9);
  CHECK(end_of_axis(box.axes[0]) == "upper");
  CHECK(end_of_axis(-box.axes[0]) == "lower");
  CHECK(end_of_axis(box.axes[1]) == "right");
  CHECK(end_of_axis(box.axes[2]) == "front");
  // The outermost 5 % of 9 steps between slices are the last slice.
  CHECK(glm::distance(box.first_pole, grid.patient_from_index({12.5, 6.5, 14})) < 1e-9);
  CHECK(glm::distance(box.second_pole, grid.patient_from_index({12.5, 6.5, 5})) < 1e-9);
}

TEST_CASE("an oblique ellipsoid's axes and poles are found to a share of a voxel") {
  const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), glm::radians(30.0), glm::dvec3(0, 1, 0)));
  const glm::dvec3 radii(12, 18, 40), middle(3, -2, 1);
  const Case subject = labelled(cube_grid(100, 1), {{1, "kidney_right", "kidney_cortex"}}, [&](const glm::dvec3& p) {
    const glm::dvec3 q = glm::transpose(turn) * (p - middle) / radii;
    return glm::dot(q, q) <= 1 ? 1 : 0;
  });
  const StructureShape kidney = structure_shapes(subject).at(0);
  CHECK(glm::distance(kidney.centroid, middle) < 0.05);
  // A solid ellipsoid deviates by its radius over the root of 5.
  CHECK(kidney.deviation_mm[0] == Approx(40 / std::sqrt(5.0)).epsilon(0.01));
  CHECK(kidney.deviation_mm[1] == Approx(18 / std::sqrt(5.0)).epsilon(0.01));
  CHECK(kidney.deviation_mm[2] == Approx(12 / std::sqrt(5.0)).epsilon(0.01));
  const glm::dvec3 long_axis = turn * glm::dvec3(0, 0, 1);  // already to the head
  CHECK(glm::dot(kidney.axes[0], long_axis) > std::cos(glm::radians(0.5)));
  // The cap above 0.9 of the radius has its centre at 3 (2 - h)^2 / (4 (3 - h)) of it with h = 0.1.
  const double cap = 3 * 1.9 * 1.9 / (4 * 2.9) * 40;
  CHECK(glm::distance(kidney.first_pole, middle + long_axis * cap) < 0.7);
  CHECK(glm::distance(kidney.second_pole, middle - long_axis * cap) < 0.7);
  CHECK(first_pole_name(kidney) == "kidney_right_upper_pole");
  CHECK(second_pole_name(kidney) == "kidney_right_lower_pole");
}

TEST_CASE("the centre of a bent structure lies in it, and a structure at the CT's edge is cut") {
  const Case subject = labelled(cube_grid(60, 1), {{1, "ring", "bowel"}, {2, "edge", "bowel"}, {3, "none", "bowel"}},
                                [](const glm::dvec3& p) {
                                  if (p.z > 28) return 2;
                                  const double r = std::hypot(p.x, p.y);
                                  return std::abs(p.z) <= 3 && r >= 15 && r <= 20 ? 1 : 0;
                                });
  const auto shapes = structure_shapes(subject);
  REQUIRE(shapes.size() == 2);  // what has no voxel has no shape
  CHECK(glm::length(shapes[0].centroid) < 1e-9);
  CHECK(glm::length(shapes[0].centre) == Approx(15).margin(0.5));
  CHECK_FALSE(shapes[0].cut);
  CHECK(shapes[1].cut);
}

TEST_CASE("two organs' contact lies half way between them where they are closest") {
  // Two blocks with 4 mm of nothing between their faces at x = -2 and 2; they face each other over y from -10 to 10.
  const Case subject = labelled(cube_grid(60, 1), {{1, "liver", "liver"}, {2, "kidney_right", "kidney_cortex"}},
                                [](const glm::dvec3& p) {
                                  if (std::abs(p.z) > 10) return 0;
                                  if (p.x < -2 && p.x > -20 && std::abs(p.y) < 20) return 1;
                                  return p.x > 2 && p.x < 20 && std::abs(p.y) < 10 ? 2 : 0;
                                });
  const auto shapes = structure_shapes(subject);
  const auto contact = contact_between(subject, shapes[0], shapes[1], 20);
  REQUIRE(contact);
  CHECK(contact->gap_mm == Approx(5));  // between the centres of the voxels on either side
  CHECK(std::abs(contact->point.x) < 0.51);
  CHECK(std::abs(contact->point.y) < 2);
  CHECK(std::abs(contact->point.z) < 2);
  CHECK_FALSE(contact_between(subject, shapes[0], shapes[1], 4.9));
}

TEST_CASE("the anatomy of a patient gives landmarks with names") {
  // A tube that leans to the left by 1 in 5 as it rises; two whole vertebrae behind it, one that the CT cuts.
  const std::vector<Label> table = {
      {1, "aorta", "blood"}, {2, "vertebrae_l2", "bone"}, {3, "vertebrae_l1", "bone"}, {4, "vertebrae_t12", "bone"}};
  const Case subject = labelled(cube_grid(121, 1), table, [](const glm::dvec3& p) {
    if (std::hypot(p.x - p.z / 5, p.y) <= 10) return 1;
    if (p.y < 20 || std::abs(p.x) > 20 || p.y > 50) return 0;
    return std::abs(p.z + 20) <= 12 ? 2 : std::abs(p.z - 10) <= 12 ? 3 : p.z > 40 ? 4 : 0;
  });
  const auto shapes = structure_shapes(subject);
  const Anatomy anatomy = find_anatomy(subject, shapes);
  REQUIRE(anatomy.vessels.size() == 1);
  const auto& levels = anatomy.vessels[0].levels;
  REQUIRE(levels.size() == 2);
  CHECK(levels[0].landmark == "aorta_l2");
  CHECK(levels[0].title == "at L2");
  CHECK(glm::distance(levels[0].point, glm::dvec3(-4, 0, -20)) < 0.3);
  CHECK(levels[1].landmark == "aorta_l1");
  CHECK(glm::dot(levels[1].along, glm::normalize(glm::dvec3(1, 0, 5))) > 0.999);
  const auto landmarks = landmarks_of(anatomy);
  REQUIRE(landmarks.size() == 2);
  CHECK(landmarks[1].name == "aorta_l1");
}
