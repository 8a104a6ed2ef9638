#include "sim/tissue/acoustic_volume.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/tissue/ct_noise.h"

using namespace insonate;

namespace {

const TissueTable& shipped() {
  static const TissueTable table = read_tissue_table(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "tissues.toml");
  return table;
}

/// A CT whose density is a function of the position along x in mm.
template <typename Density>
Volume<std::int16_t> along_x(glm::ivec3 size, double spacing_mm, Density density) {
  Volume<std::int16_t> ct;
  ct.grid.size = size;
  ct.grid.spacing = glm::dvec3(spacing_mm);
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) ct.voxels.push_back(std::int16_t(std::lround(density(i * spacing_mm))));
  return ct;
}

/// From one density to another over about `width_mm`, as a scanner blurs an edge at 20 mm.
auto edge(double from, double to, double width_mm) {
  return [=](double x) { return from + (to - from) / (1 + std::exp(-(x - 20) * 4 / width_mm)); };
}

double echogenicity_db(const AcousticVolume& volume, const glm::ivec3& i) {
  return volume.at(i).echogenicity_cdb / 100.0;
}

double darkest_db(const AcousticVolume& volume) {
  double least = 1000;
  for (const AcousticVoxel& voxel : volume.voxels) least = std::min(least, voxel.echogenicity_cdb / 100.0);
  return least;
}

}  // namespace

TEST_CASE("without labels echogenicity follows density and the CT is kept as it is") {
  for (const int hu : {-100, 5, 60}) {
    const AcousticVolume volume =
        make_acoustic_volume(along_x({8, 8, 8}, 1, [&](double) { return hu; }), {}, {}, shipped());
    CHECK(volume.grid.size == glm::ivec3(8));
    CHECK(volume.at({4, 4, 4}).hu == hu);
    CHECK(echogenicity_db(volume, {4, 4, 4}) == Approx(shipped().at(hu).echogenicity_db));
  }
}

TEST_CASE("the edge between fat and organ has no dark outline") {
  for (const double spacing : {0.8, 1.0, 3.0})
    for (const double width : {1.0, 2.0, 4.0})
      for (const auto& [from, to] : {std::pair{-100.0, 60.0}, {60.0, -100.0}, {-100.0, 400.0}}) {
        INFO("voxels of " << spacing << " mm, an edge of " << width << " mm from " << from << " to " << to << " HU");
        const auto ct = along_x({int(40 / spacing), 9, 9}, spacing, edge(from, to, width));
        // Fluid's -50 dB would be the outline; the partial-volume foot of the edge may look like loose tissue.
        CHECK(darkest_db(make_acoustic_volume(ct, {}, {}, shipped())) > -20);
      }
}

TEST_CASE("a thin layer of fluid's density between fat and an organ is tissue, and a thick one fluid") {
  // Along x; three voxels of 3 mm are 9 mm.
  const auto amid = [](double spacing_mm, double layer_mm, int before, int after) {
    const auto ct = along_x({int(60 / spacing_mm), 9, 9}, spacing_mm, [&](double x) {
      return std::abs(x - 30) < layer_mm / 2 ? 5 : x < 30 ? before : after;
    });
    return echogenicity_db(make_acoustic_volume(ct, {}, {}, shipped()), {int(std::lround(30 / spacing_mm)), 4, 4});
  };
  const double organ_db = shipped().at(60).echogenicity_db, fluid_db = shipped().at(5).echogenicity_db;
  CHECK(amid(3, 9, -100, 60) == Approx(organ_db));
  CHECK(amid(3, 9, 60, -100) == Approx(organ_db));
  CHECK(amid(3, 15, -100, 60) == Approx(fluid_db));
  CHECK(amid(1, 9, -100, 60) == Approx(organ_db));
  CHECK(amid(1, 13, -100, 60) == Approx(fluid_db));
  CHECK(amid(3, 9, -900, 60) == Approx(fluid_db));    // below gas
  CHECK(amid(3, 9, 60, 60) == Approx(fluid_db));      // a vessel
  CHECK(amid(3, 9, -100, -100) == Approx(fluid_db));  // and one amid fat
}

TEST_CASE("air scatters where it touches the body, and nowhere else") {
  const double air_db = shipped().at(-1000).echogenicity_db;
  auto ct = along_x({40, 9, 9}, 1, [](double x) { return x < 20 ? -990.0 : 60.0; });
  ct.voxels[ct.grid.offset({5, 4, 4})] = -400;  // denser than air: a part of something
  const AcousticVolume volume = make_acoustic_volume(ct, {}, {}, shipped());
  CHECK(echogenicity_db(volume, {0, 0, 0}) == kMinEchogenicity_db);  // beyond the grid there is air
  CHECK(echogenicity_db(volume, {18, 4, 4}) == kMinEchogenicity_db);
  CHECK(echogenicity_db(volume, {19, 4, 4}) == Approx(air_db));  // so that the surface's echo is not darkened
  CHECK(echogenicity_db(volume, {4, 5, 3}) == Approx(air_db));
  CHECK(echogenicity_db(volume, {3, 4, 4}) == kMinEchogenicity_db);

  Volume<std::uint8_t> labels{ct.grid, std::vector<std::uint8_t>(ct.voxels.size(), 1)};
  CHECK(echogenicity_db(make_acoustic_volume(ct, labels, {"", "lung"}, shipped()), {10, 4, 4}) > -40);
}

TEST_CASE("true fluid stays echo-free beside an organ, under noise and when it is small") {
  const auto ct = along_x({40, 9, 9}, 1, edge(5, 60, 2));
  const AcousticVolume volume = make_acoustic_volume(ct, {}, {}, shipped());
  CHECK(echogenicity_db(volume, {10, 4, 4}) < -40);
  CHECK(echogenicity_db(volume, {16, 4, 4}) < -40);
  CHECK(echogenicity_db(volume, {30, 4, 4}) > -3);

  // A vessel of 3 mm: between equal neighbours, so no edge.
  const auto vessel = along_x({40, 9, 9}, 1, [](double x) { return std::abs(x - 20) < 1.5 ? 5.0 : 60.0; });
  CHECK(echogenicity_db(make_acoustic_volume(vessel, {}, {}, shipped()), {20, 4, 4}) < -40);

  // Noise of 8 HU, evenly spread, in a cyst: hardly a voxel may fill with echoes.
  auto noisy = along_x({32, 32, 32}, 1, [](double) { return 5; });
  for (std::size_t v = 0; v < noisy.voxels.size(); ++v)
    noisy.voxels[v] = std::int16_t(5 + (unit_float(hash(std::uint32_t(v), 7)) - 0.5) * 20);
  int filled = 0;
  for (const AcousticVoxel& voxel : make_acoustic_volume(noisy, {}, {}, shipped()).voxels)
    filled += voxel.echogenicity_cdb > -2000;
  CHECK(filled == 0);
}

TEST_CASE("a label's tissue decides, and its voxels keep their texture") {
  auto ct = along_x({20, 9, 9}, 1, [](double x) { return x < 10 ? 60 : 5; });
  ct.at({5, 4, 4}) = 80;
  ct.at({6, 4, 4}) = 40;
  ct.at({7, 4, 4}) = -60;  // far off: partial volume, no texture
  Volume<std::uint8_t> labels{ct.grid, std::vector<std::uint8_t>(ct.voxels.size(), 0)};
  for (std::size_t v = 0; v < labels.voxels.size(); ++v) labels.voxels[v] = ct.voxels[v] == 5 ? 9 : 3;
  std::vector<std::string> tissue_of(256);
  tissue_of[3] = "kidney_sinus";
  tissue_of[9] = "urine";
  const AcousticVolume volume = make_acoustic_volume(ct, labels, tissue_of, shipped());
  const double sinus = shipped().labelled.at("kidney_sinus").echogenicity_db;
  CHECK(echogenicity_db(volume, {2, 4, 4}) == Approx(sinus).margin(0.1));
  CHECK(echogenicity_db(volume, {5, 4, 4}) == Approx(sinus + 2).margin(0.1));
  CHECK(echogenicity_db(volume, {6, 4, 4}) == Approx(sinus - 2).margin(0.1));
  CHECK(echogenicity_db(volume, {7, 4, 4}) == Approx(sinus).margin(0.1));
  CHECK(echogenicity_db(volume, {15, 4, 4}) == Approx(shipped().labelled.at("urine").echogenicity_db));

  // A label of no tissue in particular is judged by density.
  tissue_of[9].clear();
  CHECK(echogenicity_db(make_acoustic_volume(ct, labels, tissue_of, shipped()), {15, 4, 4}) ==
        Approx(shipped().at(5).echogenicity_db));
}

TEST_CASE("without labels density and echogenicity are those of the CT without noise") {
  // 0.2 dB per HU from -20 dB at 0 HU: nothing is fluid.
  const TissueTable table{{{-1000, 0.0004, 1, -60}, {0, 1.5, 0, -20}, {100, 1.6, 0, 0}}, {}};
  const auto even_table = [&](int hu) { return std::clamp(hu, 0, 100) * 20 - 2000; };
  auto ct = along_x({40, 40, 40}, 1, edge(20, 60, 4));
  for (std::size_t v = 0; v < ct.voxels.size(); ++v)
    ct.voxels[v] = std::int16_t(ct.voxels[v] + (unit_float(hash(std::uint32_t(v), 5)) - 0.5) * 60);
  const Volume<std::int16_t> quiet = without_noise(ct, ct_noise_hu(ct));
  const AcousticVolume volume = make_acoustic_volume(ct, {}, {}, table);
  int partial = 0;
  for (int z = 0; z < 40; ++z)
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const glm::ivec3 i(x, y, z);
        const int hu = quiet.at(i);
        int brightest = hu;
        for (int axis = 0; axis < 3; ++axis) {  // 2 mm to either side
          glm::ivec3 step(0);
          step[axis] = 2;
          if (!ct.grid.contains(i - step) || !ct.grid.contains(i + step)) continue;
          const int before = quiet.at(i - step), behind = quiet.at(i + step);
          if (std::min(before, behind) <= hu - kEdgeMargin_hu && std::max(before, behind) >= hu + kEdgeMargin_hu)
            brightest = std::max({brightest, before, behind});
        }
        partial += brightest != hu;
        const int from_end = std::min(z, 39 - z);  // the first and the last 8 mm absorb
        const int expected = from_end < 8 ? -6000 - (8 - from_end) * 10000 / 8 : even_table(brightest);
        if (volume.at(i).hu != hu || volume.at(i).echogenicity_cdb != expected)
          FAIL("voxel (" << x << ", " << y << ", " << z << ")");
      }
  CHECK(volume.at({5, 20, 20}).hu != ct.at({5, 20, 20}));
  CHECK(partial == 0);  // this edge is not steep enough
}

TEST_CASE("a voxel between two that enclose its density by a margin takes the brighter one's echogenicity") {
  const TissueTable table{{{-1000, 0.0004, 1, -60}, {0, 1.5, 0, -50}, {200, 1.6, 0, 0}}, {}};
  // 100 HU within `half_width_mm` of x = 15 mm, too far from what lies beside it to be taken for noise.
  const auto between = [&](double spacing_mm, double half_width_mm, int low, int high) {
    const auto ct = along_x({31, 9, 9}, spacing_mm, [&](double x) {
      return std::abs(x - 15) < half_width_mm ? 100 : x < 15 ? low : high;
    });
    return make_acoustic_volume(ct, {}, {}, table).at({int(std::lround(15 / spacing_mm)), 4, 4}).echogenicity_cdb;
  };
  const int own = -2500, of_180 = -500;
  CHECK(between(1.5, 1, 20, 180) == of_180);
  CHECK(between(1.5, 1, 180, 20) == of_180);
  CHECK(between(1.5, 1, 180, 180) == own);
  CHECK(between(1.5, 2, 20, 180) == own);     // 2 mm are 1 voxel of 1.5 mm
  CHECK(between(1.0, 2, 20, 180) == of_180);  // and 2 voxels of 1 mm
  CHECK(between(1.0, 2.5, 20, 180) == own);
}

TEST_CASE("a label's texture fades out towards partial volume, within the range of echogenicities") {
  auto ct = along_x({20, 9, 9}, 1, [](double) { return 60; });
  ct.at({5, 4, 4}) = 90;  // pairs, which leave the label's mean at 60 HU
  ct.at({6, 4, 4}) = 30;
  ct.at({7, 4, 4}) = 105;
  ct.at({8, 4, 4}) = 15;
  ct.at({9, 4, 4}) = 120;
  ct.at({10, 4, 4}) = 0;
  const Volume<std::uint8_t> labels{ct.grid, std::vector<std::uint8_t>(ct.voxels.size(), 1)};
  const auto of_tissue = [&](double db) {
    const TissueTable table{shipped().knots, {{"tissue", {db}}}};
    const AcousticVolume volume = make_acoustic_volume(ct, labels, {"", "tissue"}, table);
    std::vector<int> cdb;
    for (int i = 4; i < 11; ++i) cdb.push_back(volume.at({i, 4, 4}).echogenicity_cdb);
    return cdb;
  };
  CHECK(of_tissue(-7) == std::vector<int>{-700, -400, -1000, -475, -925, -700, -700});
  CHECK(of_tissue(28) == std::vector<int>{2800, 3000, 2500, 3000, 2575, 2800, 2800});
  CHECK(of_tissue(-58) == std::vector<int>{-5800, -5500, -6000, -5575, -6000, -5800, -5800});
}

TEST_CASE("the density of a labelled fluid is even, that of a labelled organ is the CT's") {
  auto ct = along_x({20, 9, 9}, 1, [](double) { return 20; });
  ct.at({5, 4, 4}) = 45;  // pairs, which leave the label's mean at 20 HU
  ct.at({6, 4, 4}) = -5;
  ct.at({7, 4, 4}) = 65;  // half way out of the texture's range
  ct.at({8, 4, 4}) = -25;
  ct.at({9, 4, 4}) = 90;  // the rim
  ct.at({10, 4, 4}) = -50;
  const Volume<std::uint8_t> labels{ct.grid, std::vector<std::uint8_t>(ct.voxels.size(), 1)};
  const auto density_of = [&](const char* tissue) {
    const AcousticVolume volume = make_acoustic_volume(ct, labels, {"", tissue}, shipped());
    std::vector<int> hu;
    for (int i = 4; i < 11; ++i) hu.push_back(volume.at({i, 4, 4}).hu);
    return hu;
  };
  for (const char* fluid : {"bile", "blood"}) CHECK(density_of(fluid) == std::vector<int>{20, 20, 20, 42, -2, 90, -50});
  CHECK(density_of("liver") == std::vector<int>{20, 45, -5, 65, -25, 90, -50});
}

TEST_CASE("tissue at the head's and the feet's end of a CT absorbs more and more, whichever axis leads there") {
  const auto ct_along = [](int axis, glm::ivec3 of_size) {
    Volume<std::int16_t> ct = along_x(of_size, 3, [](double x) { return x < 10 ? -1000 : 60; });
    ct.grid.direction = glm::dmat3(0);
    for (int i = 0; i < 3; ++i) ct.grid.direction[(axis + i) % 3][(i + 2) % 3] = 1;
    return ct;
  };
  const glm::ivec3 size(16, 14, 12), middle(8, 7, 6);
  for (const int axis : {0, 1, 2}) {
    const AcousticVolume volume = make_acoustic_volume(ct_along(axis, size), {}, {}, shipped());
    for (const bool last : {false, true}) {
      std::vector<double> db;
      for (int k = 0; k < 4; ++k) {
        glm::ivec3 i = middle;
        i[axis] = last ? size[axis] - 1 - k : k;
        if (volume.at(i).hu == 60) db.push_back(echogenicity_db(volume, i));
      }
      if (axis == 0 && !last) {
        CHECK(db.empty());  // that end lies in air
        CHECK(echogenicity_db(volume, {0, 7, 6}) == kMinEchogenicity_db);
      } else {
        REQUIRE(db.size() == 4);
        CHECK(db[0] == kEnd_db);
        CHECK(db[1] == Approx(-60 - 200.0 / 3).margin(0.01));
        CHECK(db[2] == Approx(-60 - 100.0 / 3).margin(0.01));
        CHECK(db[3] == 0);
      }
    }
  }
  // Too few slices to lose any: of eleven, six.
  const AcousticVolume thin = make_acoustic_volume(ct_along(2, {16, 14, 11}), {}, {}, shipped());
  CHECK(echogenicity_db(thin, {8, 7, 0}) == 0);

  CHECK(end_absorption(kMinEchogenicity_db) == 0);
  CHECK(end_absorption(-71) == Approx(0.6));
  CHECK(end_absorption(kEnd_db) > 40);  // more than lung
}

TEST_CASE("a label's unknown tissue is refused with the name it resembles") {
  const auto ct = along_x({4, 4, 4}, 1, [](double) { return 0; });
  const Volume<std::uint8_t> labels{ct.grid, std::vector<std::uint8_t>(ct.voxels.size(), 1)};
  std::vector<std::string> tissue_of(256);
  tissue_of[1] = "livr";
  CHECK_THROWS_WITH(make_acoustic_volume(ct, labels, tissue_of, shipped()), Catch::Contains("did you mean 'liver'?"));
  Volume<std::uint8_t> elsewhere = labels;
  elsewhere.grid.size = {2, 8, 4};
  tissue_of[1] = "liver";
  CHECK_THROWS_AS(make_acoustic_volume(ct, elsewhere, tissue_of, shipped()), std::invalid_argument);
}

TEST_CASE("the acoustic volume is the same to the bit on any number of threads") {
  auto ct = along_x({61, 47, 33}, 1.3, edge(-100, 60, 9));
  Volume<std::uint8_t> labels{ct.grid, std::vector<std::uint8_t>(ct.voxels.size())};
  for (std::size_t v = 0; v < ct.voxels.size(); ++v) {
    ct.voxels[v] = std::int16_t(ct.voxels[v] + int(unit_float(hash(std::uint32_t(v), 1)) * 60));
    labels.voxels[v] = std::uint8_t(hash(std::uint32_t(v), 2) % 4);
  }
  std::vector<std::string> tissue_of(256);
  tissue_of[1] = "liver";
  tissue_of[2] = "blood";
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return make_acoustic_volume(ct, labels, tissue_of, shipped());
  };
  const AcousticVolume one = with_threads(1), many = with_threads(7);
  CHECK(std::memcmp(one.voxels.data(), many.voxels.data(), one.voxels.size() * sizeof(AcousticVoxel)) == 0);
}
