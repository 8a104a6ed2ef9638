#include "sim/tissue/tissue_structure.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/tissue/acoustic_volume.h"

using namespace insonate;

namespace {

const TissueTable& shipped() {
  static const TissueTable table = read_tissue_table(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "tissues.toml");
  return table;
}

const std::vector<std::string> kTissues = {"", "liver", "spleen", "muscle", "fat", "bowel", "pancreas", "blood"};

/// A block of one density in air, whose skin is a plane at the front. Its depth grows with j.
struct Block {
  Volume<std::int16_t> ct;
  Volume<std::uint8_t> labels;

  Block(const glm::ivec3& size, int hu, int label, double spacing_mm = 1) {
    ct.grid.size = size;
    ct.grid.spacing = glm::dvec3(spacing_mm);
    ct.voxels.assign(ct.grid.count(), std::int16_t(hu));
    if (label) labels = {ct.grid, std::vector<std::uint8_t>(ct.voxels.size(), std::uint8_t(label))};
    for (int k = 0; k < size.z; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < size.x; ++i) {
          ct.at({i, j, k}) = -1000;
          if (label) labels.at({i, j, k}) = 0;
        }
  }

  std::vector<std::int16_t> structure(std::uint32_t seed = kStructureSeed) const {
    return tissue_structure_cdb(ct, labels, kTissues, shipped(), seed);
  }
};

struct Statistics {
  double mean = 0, deviation = 0, most = 0;  ///< dB
};

/// Of the voxels that air does not take.
Statistics statistics_of(const Block& block, const std::vector<std::int16_t>& cdb) {
  double sum = 0, squares = 0, count = 0, most = 0;
  for (std::size_t v = 0; v < cdb.size(); ++v) {
    if (block.ct.voxels[v] == -1000) continue;
    const double db = cdb[v] / 100.0;
    sum += db;
    squares += db * db;
    most = std::max(most, std::abs(db));
    ++count;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean), most};
}

/// Returns the correlation of voxels that lie `lag` apart, of every second voxel along each axis, at least 20 voxels
/// from the borders.
double correlation(const Grid& grid, const std::vector<std::int16_t>& cdb, const glm::ivec3& lag) {
  constexpr int kMargin = 20;
  double products = 0, a_squares = 0, b_squares = 0;
  for (int k = kMargin; k + lag.z < grid.size.z - kMargin; k += 2)
    for (int j = kMargin; j + lag.y < grid.size.y - kMargin; j += 2)
      for (int i = kMargin; i + lag.x < grid.size.x - kMargin; i += 2) {
        const double a = cdb[grid.offset({i, j, k})], b = cdb[grid.offset(glm::ivec3(i, j, k) + lag)];
        products += a * b;
        a_squares += a * a;
        b_squares += b * b;
      }
  return products / std::sqrt(a_squares * b_squares);
}

int label_of(const std::string& tissue) {
  return int(std::find(kTissues.begin(), kTissues.end(), tissue) - kTissues.begin());
}

}  // namespace

TEST_CASE("structure has zero mean and is bounded") {
  const glm::ivec3 size(80, 84, 80);
  for (const std::string tissue : {"liver", "spleen", "muscle", "fat", "bowel", "pancreas"}) {
    INFO(tissue);
    const Block block(size, tissue == "fat" ? -100 : 55, label_of(tissue));
    const Statistics s = statistics_of(block, block.structure());
    CHECK(std::abs(s.mean) < 0.05);
    CHECK(s.deviation > 0.2);
    CHECK(s.most <= kMaxStructure_db);
  }
  for (const int hu : {-100, 55}) {  // no label, so that no label's mean is taken away
    INFO(hu << " HU");
    const Block block({120, 120, 120}, hu, 0);
    const Statistics s = statistics_of(block, block.structure());
    CHECK(std::abs(s.mean) < 0.15);
    CHECK(s.deviation > 0.5);
    CHECK(s.most <= kMaxStructure_db);
  }
}

TEST_CASE("structure differs between tissues as the tissues do") {
  struct Sample {
    Block block;
    std::vector<std::int16_t> cdb;
    explicit Sample(const std::string& tissue) : block({100, 100, 100}, 55, label_of(tissue)), cdb(block.structure()) {}
    double deviation() const { return statistics_of(block, cdb).deviation; }
    double along(const glm::ivec3& lag) const { return correlation(block.ct.grid, cdb, lag); }
  };
  const Sample spleen("spleen"), liver("liver"), muscle("muscle"), bowel("bowel");
  CHECK(spleen.deviation() < 0.6);
  CHECK(liver.deviation() > 3 * spleen.deviation());
  CHECK(muscle.deviation() > liver.deviation());
  CHECK(bowel.deviation() > liver.deviation());

  // Fibres run along the body. Their sheets lie parallel to the skin, which is the plane y = 4 mm here.
  CHECK(muscle.along({0, 0, 6}) > 0.4);
  CHECK(muscle.along({6, 0, 0}) < muscle.along({0, 0, 6}));
  CHECK(muscle.along({0, 6, 0}) < 0.2);
  const double x = liver.along({3, 0, 0}), y = liver.along({0, 3, 0}), z = liver.along({0, 0, 3});
  CHECK(std::max({x, y, z}) - std::min({x, y, z}) < 0.1);
  // Spleen is finer than liver.
  CHECK(spleen.along({3, 0, 0}) < 0.1);
  CHECK(x > 0.15);
}

TEST_CASE("structure does not repeat") {
  for (const std::string tissue : {"liver", "muscle", "spleen"}) {
    const Block block({180, 180, 180}, 55, label_of(tissue));
    const std::vector<std::int16_t> cdb = block.structure();
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int lag = tissue == "muscle" && axis != 1 ? 50 : 20; lag < 90; lag += 2) {
        glm::ivec3 step(0);
        step[axis] = lag;
        largest = std::max(largest, correlation(block.ct.grid, cdb, step));
      }
    INFO(tissue);
    CHECK(largest < 0.1);
  }
}

TEST_CASE("structure is fixed to the patient and follows from the seed") {
  const Block block({90, 90, 90}, 55, label_of("liver"));
  const std::vector<std::int16_t> whole = block.structure();
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(block.structure() == whole);
  }
  CHECK(block.structure(7) != whole);

  // The same patient on a grid that begins elsewhere and runs the other way along x: but for the label's mean, equal.
  Block other({50, 50, 50}, 55, label_of("liver"));
  other.ct.grid.origin = {79, 30, 20};
  other.ct.grid.direction[0] = {-1, 0, 0};
  other.labels.grid = other.ct.grid;
  const std::vector<std::int16_t> part = other.structure();
  int least = 10000, most = -10000;
  for (int k = 0; k < 50; ++k)
    for (int j = 4; j < 50; ++j)
      for (int i = 0; i < 50; ++i) {
        const int here = part[other.ct.grid.offset({i, j, k})];
        const int there = whole[block.ct.grid.offset({79 - i, 30 + j, 20 + k})];
        if (std::max(std::abs(here), std::abs(there)) > 750) continue;  // may be clamped
        least = std::min(least, here - there);
        most = std::max(most, here - there);
      }
  CHECK(most - least <= 2);
}

TEST_CASE("fluid, blood, bone and air have no structure, and large voxels hold none") {
  for (const int hu : {-1000, -500, 200, 1000}) {
    const Block block({40, 40, 40}, hu, 0);
    const std::vector<std::int16_t> cdb = block.structure();
    CHECK(std::all_of(cdb.begin(), cdb.end(), [](int value) { return value == 0; }));
  }
  const Block blood({40, 40, 40}, 55, label_of("blood"));
  const std::vector<std::int16_t> cdb = blood.structure();
  CHECK(std::all_of(cdb.begin(), cdb.end(), [](int value) { return value == 0; }));
  const Block coarse({40, 40, 40}, 55, label_of("liver"), 3);
  const std::vector<std::int16_t> none = coarse.structure();
  CHECK(std::all_of(none.begin(), none.end(), [](int value) { return value == 0; }));

  // Fluid stays below what any display shows.
  const Block fluid({60, 60, 60}, 5, 0);
  for (const AcousticVoxel& voxel : make_acoustic_volume(fluid.ct, {}, {}, shipped(), true).voxels)
    if (voxel.hu == 5 && voxel.echogenicity_cdb > -4000) FAIL("an echo in fluid");
}

TEST_CASE("a kidney with a sinus has pyramids around it, unless the case has a medulla") {
  Block body({80, 80, 80}, -100, 0);
  body.labels = {body.ct.grid, std::vector<std::uint8_t>(body.ct.voxels.size(), 0)};
  std::vector<std::string> tissue_of = {"", "kidney_cortex", "kidney_sinus"};
  const auto from_centre = [](const glm::ivec3& i) { return glm::length(glm::dvec3(i) - 40.0); };
  const auto each = [&](const auto& act) {
    for (int k = 0; k < 80; ++k)
      for (int j = 0; j < 80; ++j)
        for (int i = 0; i < 80; ++i) act(glm::ivec3(i, j, k));
  };
  each([&](const glm::ivec3& i) {
    if (from_centre(i) < 28) body.ct.at(i) = 40;
    body.labels.at(i) = from_centre(i) < 10 ? 2 : from_centre(i) < 28 ? 1 : 0;
  });
  const auto mean_between = [&](const std::vector<std::int16_t>& cdb, double from, double to) {
    double sum = 0, count = 0;
    each([&](const glm::ivec3& i) {
      if (from_centre(i) < from || from_centre(i) >= to) return;
      sum += cdb[body.ct.grid.offset(i)] / 100.0;
      ++count;
    });
    return sum / count;
  };
  const auto structure = [&] { return tissue_structure_cdb(body.ct, body.labels, tissue_of, shipped()); };
  const std::vector<std::int16_t> with_pyramids = structure();
  CHECK(mean_between(with_pyramids, 11, 20) < mean_between(with_pyramids, 24, 28) - 2);
  CHECK(std::abs(mean_between(with_pyramids, 10, 28)) < 0.05);

  // Columns of cortex lie between: at one distance from the sinus there is bright and dark.
  double brightest = -100, darkest = 100;
  each([&](const glm::ivec3& i) {
    if (std::abs(from_centre(i) - 15) > 1) return;
    brightest = std::max(brightest, with_pyramids[body.ct.grid.offset(i)] / 100.0);
    darkest = std::min(darkest, with_pyramids[body.ct.grid.offset(i)] / 100.0);
  });
  CHECK(brightest - darkest > 5);

  tissue_of.push_back("kidney_medulla");
  const std::vector<std::int16_t> with_medulla = structure();
  CHECK(std::abs(mean_between(with_medulla, 11, 20) - mean_between(with_medulla, 24, 28)) < 0.2);
}

TEST_CASE("a sinus is uneven and fades towards the parenchyma, but not where it meets the fat of the hilum") {
  Block body({80, 80, 80}, -100, 0);
  body.labels = {body.ct.grid, std::vector<std::uint8_t>(body.ct.voxels.size(), 0)};
  const auto from_centre = [](const glm::ivec3& i) { return glm::length(glm::dvec3(i) - 40.0); };
  const auto each = [&](const auto& act) {
    for (int k = 0; k < 80; ++k)
      for (int j = 0; j < 80; ++j)
        for (int i = 0; i < 80; ++i) act(glm::ivec3(i, j, k));
  };
  // Half a kidney: the sinus is open at i = 40.
  each([&](const glm::ivec3& i) {
    if (i.x >= 40) body.labels.at(i) = from_centre(i) < 18 ? 2 : from_centre(i) < 32 ? 1 : 0;
  });
  const auto of_sinus = [&](const char* parenchyma, const auto& where) {
    const std::vector<std::string> tissue_of = {"", parenchyma, "kidney_sinus"};
    const std::vector<std::int16_t> cdb = tissue_structure_cdb(body.ct, body.labels, tissue_of, shipped());
    double sum = 0, squares = 0, count = 0;
    each([&](const glm::ivec3& i) {
      if (body.labels.at(i) != 2 || !where(i)) return;
      const double db = cdb[body.ct.grid.offset(i)] / 100.0;
      sum += db;
      squares += db * db;
      ++count;
    });
    return std::pair(sum / count, std::sqrt(squares / count - sum / count * sum / count));
  };
  const auto rim = [&](const glm::ivec3& i) { return from_centre(i) >= 16 && i.x > 46; };
  const auto middle = [&](const glm::ivec3& i) { return from_centre(i) < 10 && i.x > 44; };
  const auto hilum = [&](const glm::ivec3& i) { return i.x < 42 && from_centre(i) < 10; };
  const auto anywhere = [](const glm::ivec3&) { return true; };
  for (const char* parenchyma : {"kidney_cortex", "kidney_medulla"}) {
    INFO(parenchyma);
    CHECK(of_sinus(parenchyma, rim).first < of_sinus(parenchyma, middle).first - 3);
    CHECK(std::abs(of_sinus(parenchyma, hilum).first - of_sinus(parenchyma, middle).first) < 1.5);
    CHECK(std::abs(of_sinus(parenchyma, anywhere).first) < 0.05);
    CHECK(of_sinus(parenchyma, middle).second > 2);
  }
  // Beside anything else it has no rim.
  CHECK(std::abs(of_sinus("fat", rim).first - of_sinus("fat", middle).first) < 1.5);
}

TEST_CASE("the acoustic volume takes structure only when asked, and keeps densities") {
  const Block block({60, 60, 60}, 55, label_of("liver"));
  const AcousticVolume plain = make_acoustic_volume(block.ct, block.labels, kTissues, shipped()),
                       with = make_acoustic_volume(block.ct, block.labels, kTissues, shipped(), true);
  const std::vector<std::int16_t> cdb = block.structure();
  bool differs = false;
  for (std::size_t v = 0; v < cdb.size(); ++v) {
    const AcousticVoxel &before = plain.voxels[v], &now = with.voxels[v];
    if (before.hu != now.hu) FAIL("a density changed");
    if (before.echogenicity_cdb == -6000) {
      if (now.echogenicity_cdb != -6000) FAIL("silence has an echo");
      continue;
    }
    if (before.echogenicity_cdb < -6000) continue;  // the CT's ends
    if (now.echogenicity_cdb - before.echogenicity_cdb != cdb[v]) FAIL("not the structure's shift");
    differs = differs || cdb[v] != 0;
  }
  CHECK(differs);
}
