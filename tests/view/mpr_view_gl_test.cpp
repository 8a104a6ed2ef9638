#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

#include "sim/view/mpr_view.h"
#include "tests/view/test_patient.h"

using namespace insonate;
using view::MprPicture;
using view::MprView;
using view::SweptTexture;

namespace {

double ramp(const glm::dvec3& p) {
  return 120 + 1.3 * p.x - 0.9 * p.y + 1.1 * p.z;
}

/// Oblique, with axes that the volume does not have.
MprPicture oblique_picture() {
  MprPicture picture;
  picture.patient_from_picture = {
      glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.6, glm::normalize(glm::dvec3(0.2, -1, 0.4)))), {2, -3, 4}};
  picture.mm_per_pixel = 0.4;
  picture.width = 101;
  picture.height = 81;
  return picture;
}

glm::dvec3 place_of(const MprPicture& picture, int x, int y) {
  return picture.patient_from_picture.point({picture.mm_per_pixel * (x - (picture.width - 1) / 2.0),
                                             picture.mm_per_pixel * (y - (picture.height - 1) / 2.0), 0});
}

struct Swept {
  Volume<std::uint8_t> grey, known;
  explicit Swept(const Grid& grid)
      : grey{grid, std::vector<std::uint8_t>(grid.count())}, known{grid, std::vector<std::uint8_t>(grid.count(), 2)} {
    for (int k = 0; k < grid.size.z; ++k)
      for (int j = 0; j < grid.size.y; ++j)
        for (int i = 0; i < grid.size.x; ++i)
          grey.at({i, j, k}) =
              std::uint8_t(std::lround(std::clamp(ramp(grid.patient_from_index({i, j, k})), 0.0, 255.0)));
  }
};

}  // namespace

// One grey level: voxels hold whole ones, and so do pixels.
TEST_CASE("a reformatted plane shows the volume's grey level at each pixel's place in the patient") {
  test::Scene::need_context();
  const Swept swept(test::skewed_grid(60));
  const SweptTexture texture(swept.grey, swept.known);
  MprView view;
  const MprPicture picture = oblique_picture();
  const Image<Rgba8> image = test::read(view.render(texture, picture));
  REQUIRE(image.width == picture.width);
  REQUIRE(image.height == picture.height);
  double worst = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(image.at(x, y)[c] - std::clamp(ramp(place_of(picture, x, y)), 0.0, 255.0)));
  CHECK(worst <= 1.0);
}

TEST_CASE(
    "A reformatted plane is dark where nothing is known, bluish where voxels are filled, and has no dark border") {
  test::Scene::need_context();
  Grid grid;
  grid.size = {30, 30, 30};
  grid.origin = glm::dvec3(-14.5);
  Swept swept(grid);
  for (int k = 0; k < 30; ++k)
    for (int j = 0; j < 30; ++j)
      for (int i = 0; i < 30; ++i) {
        swept.grey.at({i, j, k}) = i < 10 ? 0 : 200;
        swept.known.at({i, j, k}) = i < 10 ? 0 : i < 20 ? 1 : 2;
      }
  const SweptTexture texture(swept.grey, swept.known);
  MprView view;
  MprPicture picture;
  picture.mm_per_pixel = 0.25;
  picture.width = 160;
  picture.height = 20;
  const auto at_mm = [&](const Image<Rgba8>& image, double x_mm) {
    return image.at(int(std::lround(x_mm / 0.25 + 79.5)), 10);
  };
  const Image<Rgba8> tinted = test::read(view.render(texture, picture));
  CHECK(at_mm(tinted, -18)[0] < 20);  // beyond the volume
  CHECK(at_mm(tinted, -10)[0] < 20);
  CHECK(at_mm(tinted, 0)[2] == 200);
  CHECK(at_mm(tinted, 0)[0] < 160);
  CHECK(at_mm(tinted, 10)[0] == 200);
  CHECK(at_mm(tinted, -4.8)[2] == 200);  // the first known voxel's outer half
  picture.tints_filled = false;
  CHECK(at_mm(test::read(view.render(texture, picture)), 0)[0] == 200);
}

TEST_CASE("a reformatted plane is drawn again only when it changes or is forgotten") {
  test::Scene::need_context();
  const Swept swept(test::skewed_grid(20));
  const SweptTexture texture(swept.grey, swept.known);
  MprView view;
  MprPicture picture = oblique_picture();
  view.render(texture, picture);
  view.render(texture, picture);
  CHECK(view.renders() == 1);
  picture.patient_from_picture.translation.x += 0.1;
  view.render(texture, picture);
  CHECK(view.renders() == 2);
  view.forget();
  view.render(texture, picture);
  CHECK(view.renders() == 3);
}
