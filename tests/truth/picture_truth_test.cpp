#include "sim/truth/picture_truth.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenarios/metrics/visibility.h"
#include "sim/core/hash.h"
#include "sim/files/files.h"
#include "sim/phantom/phantom.h"

using namespace insonate;

namespace {

const TissueTable& tissues() {
  static const TissueTable table = read_tissue_table(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "tissues.toml");
  return table;
}

constexpr double kSkin_mm = 10;  // air down to half a voxel in front of this y

/// A block of tissue behind air, label 3 on the right and 7 on the left, with a plate of bone in front of a part.
Case block() {
  Case subject;
  subject.ct.grid.size = glm::ivec3(121, 100, 41);
  subject.ct.grid.origin = glm::dvec3(-60, 0, -20);
  subject.ct.voxels.assign(subject.ct.grid.count(), 50);
  subject.labels.grid = subject.ct.grid;
  subject.labels.voxels.assign(subject.ct.grid.count(), 0);
  for (int z = 0; z < 41; ++z)
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 121; ++x) {
        const glm::ivec3 at(x, y, z);
        if (y < kSkin_mm) subject.ct.at(at) = -1000;
        if (y >= kSkin_mm) subject.labels.at(at) = x < 60 ? 3 : 7;
        if (y >= 30 && y < 40 && x > 65 && x < 75) subject.ct.at(at) = 1500;
      }
  return subject;
}

Settings picture(int width, int height, double frequency_mhz) {
  Settings settings;
  settings.image_width = width;
  settings.image_height = height;
  settings.frequency_mhz = frequency_mhz;
  return settings;
}

/// Looks along +y with the marker towards +x.
Pose from_front(double y_mm) {
  return {glm::dmat3(1.0), glm::dvec3(0.25, y_mm, 0.25)};
}

const Probe& linear() {
  return *find_probe("linear");
}

}  // namespace

TEST_CASE("each pixel has the label of its nearest voxel, and none outside the fan") {
  const Case subject = block();
  TruthMaker maker(subject, tissues());
  const Pose pose = from_front(12);
  maker.set_view(linear(), 50, picture(200, 150, 7.5));
  const PictureTruth truth = maker.at(pose);
  const ImageGeometry geometry = image_geometry(linear(), 50, 200, 150);
  const glm::dmat4 to_patient = patient_from_pixel(geometry, pose);
  int outside = 0, left = 0, right = 0;
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 200; ++x) {
      const bool in_fan = line_position(linear(), 50, geometry.plane_mm(x, y)).has_value();
      const glm::dvec3 p(to_patient * glm::dvec4(x, y, 0, 1));
      const int wanted = in_fan ? sample_nearest(subject.labels, subject.ct.grid.index_from_patient(p)) : 0;
      REQUIRE(int(truth.label.at(x, y)) == wanted);
      REQUIRE((truth.reach.at(x, y) != int(Reach::outside)) == in_fan);
      outside += !in_fan;
      left += wanted == 3;
      right += wanted == 7;
    }
  CHECK(outside > 1000);
  CHECK(left > 5000);
  CHECK(right > 5000);
}

TEST_CASE("sound does not arrive behind bone, and its labels are not visible there") {
  const Case subject = block();
  TruthMaker maker(subject, tissues());
  maker.set_view(linear(), 50, picture(200, 150, 7.5));
  const PictureTruth truth = maker.at(from_front(12));
  const ImageGeometry geometry = image_geometry(linear(), 50, 200, 150);
  const auto reach_at = [&](double x_mm, double depth_mm) {
    const glm::dvec2 pixel = geometry.pixel({x_mm, depth_mm});
    return Reach(truth.reach.at(int(std::lround(pixel.x)), int(std::lround(pixel.y))));
  };
  CHECK(reach_at(9, 10) == Reach::arrives);   // in front of the plate
  CHECK(reach_at(9, 40) == Reach::shadowed);  // behind it
  CHECK(reach_at(-9, 40) == Reach::arrives);  // beside it
  CHECK(reach_at(17, 40) == Reach::arrives);  // on its other side
  for (std::size_t i = 0; i < truth.label.pixels.size(); ++i) {
    const bool arrives = truth.reach.pixels[i] == int(Reach::arrives);
    REQUIRE(int(truth.visible_label.pixels[i]) == (arrives ? int(truth.label.pixels[i]) : 0));
  }
}

TEST_CASE("the distance to the skin is positive in front of it, negative where the face is pressed in") {
  const Case subject = block();
  TruthMaker maker(subject, tissues());
  maker.set_view(linear(), 50, picture(64, 64, 7.5));
  // The skin is at -500 HU, which lies between the voxels of -1000 and 50 HU at y = 9 and 10.
  const double skin_y = 9 + 500.0 / 1050;
  for (const double y : {4.0, 8.5, 12.0, 15.0})
    for (const float distance : maker.at(from_front(y)).skin_mm) CHECK(distance == Approx(skin_y - y).margin(0.011));
  // Off the block, no line meets it.
  Pose away = from_front(12);
  away.translation.x = 500;
  for (const float distance : maker.at(away).skin_mm) CHECK(std::isnan(distance));
}

TEST_CASE("sound arrives where the scores say that it does") {
  const std::filesystem::path recipe = std::filesystem::path(INSONATE_ASSETS_FOLDER) / "phantoms" / "abdomen.toml";
  const Case subject = make_phantom(recipe.string(), read_file(recipe), {{"voxel_mm", "4"}});
  const ReferenceView& view = *subject.find_view("hepatorenal");
  Probe probe = *find_probe(view.probe);
  probe.lines = Visibility::kLines;
  TruthMaker maker(subject, tissues());
  constexpr int kSize = 256;
  maker.set_view(probe, view.depth_mm, picture(kSize, kSize, probe.frequency_mhz));
  const PictureTruth truth = maker.at(view.patient_from_probe);
  Visibility visibility(subject, probe, view.depth_mm, tissues());
  visibility.look_from(view.patient_from_probe);
  const ImageGeometry geometry = image_geometry(probe, view.depth_mm, kSize, kSize);
  const glm::dmat4 to_patient = patient_from_pixel(geometry, view.patient_from_probe);
  int compared = 0, shadowed = 0, differing = 0;
  for (std::uint32_t n = 0; n < 20000; ++n) {
    const int x = int(hash(n, 1) % kSize), y = int(hash(n, 2) % kSize);
    if (truth.reach.at(x, y) == int(Reach::outside)) continue;
    // Scores count gel in another way. Where the face is this deep in the skin, there is none.
    const double line = line_position(probe, view.depth_mm, geometry.plane_mm(x, y))->line;
    if (truth.skin_mm[std::size_t(std::clamp(std::lround(line), 0l, long(probe.lines) - 1))] > -4) continue;
    ++compared;
    shadowed += truth.reach.at(x, y) == int(Reach::shadowed);
    differing += visibility.reaches(glm::dvec3(to_patient * glm::dvec4(x, y, 0, 1))) !=
                 (truth.reach.at(x, y) == int(Reach::arrives));
  }
  CHECK(compared > 5000);
  CHECK(shadowed > 100);
  // The pixel's place is rounded twice, so that few lie on the other side of a line or sample.
  CHECK(differing <= compared / 1000);
}

TEST_CASE("the skin's outermost voxels count as gel in part, so that they cast no shadow") {
  Case subject = block();
  // A skin that rises from air to tissue over three voxels.
  for (int z = 0; z < 41; ++z)
    for (int x = 0; x < 121; ++x)
      for (int y = 7; y < 10; ++y) subject.ct.at({x, y, z}) = std::int16_t(-1000 + 250 * (y - 6));
  TruthMaker maker(subject, tissues());
  Settings settings = picture(100, 100, 7.5);
  const auto shadowed = [&] {
    maker.set_view(linear(), 50, settings);
    const PictureTruth truth = maker.at(from_front(5));
    return std::count(truth.reach.pixels.begin(), truth.reach.pixels.end(), std::uint8_t(Reach::shadowed));
  };
  const auto with_gel = shadowed();
  settings.gel_mm = 0;
  CHECK(shadowed() > 5000);  // air in front of the face
  CHECK(with_gel < 2500);    // behind the plate alone
}

TEST_CASE("another view of the same maker gives what a new maker gives") {
  const Case subject = block();
  TruthMaker used(subject, tissues());
  used.set_view(linear(), 50, picture(64, 64, 7.5));
  used.at(from_front(12));
  used.set_view(*find_probe("curvilinear"), 80, picture(96, 64, 3.5));
  used.set_view(*find_probe("curvilinear"), 80, picture(96, 64, 5));
  TruthMaker fresh(subject, tissues());
  fresh.set_view(*find_probe("curvilinear"), 80, picture(96, 64, 5));
  const PictureTruth a = used.at(from_front(9)), b = fresh.at(from_front(9));
  CHECK(a.label.pixels == b.label.pixels);
  CHECK(a.reach.pixels == b.reach.pixels);
  CHECK(a.skin_mm == b.skin_mm);
}
