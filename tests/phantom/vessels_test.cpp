#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "tests/phantom/abdomen.h"

using namespace insonate;

// What a sonographer looks for inside the organs, at the voxel size at which the trainer makes them.

namespace {

// The recipe with a smaller box and without its views, which look from outside of it.
Case part_of_abdomen(const std::string& from, const std::string& to, const std::string& voxel_mm = "1") {
  std::string recipe = read_file(kRecipe);
  const std::string whole = "from = [-176, -114, -194], to = [176, 124, 204]";
  REQUIRE(recipe.find(whole) != std::string::npos);
  recipe.replace(recipe.find(whole), whole.size(), "from = " + from + ", to = " + to);
  recipe.erase(recipe.find("\nviews = ["));
  return make_phantom(kRecipe.string(), recipe, {{"voxel_mm", voxel_mm}});
}

std::set<std::uint8_t> values(const Case& subject, const std::set<std::string>& names) {
  std::set<std::uint8_t> found;
  for (const std::string& name : names) found.insert(subject.find_label(name)->value);
  return found;
}

// The sizes in voxels of the connected parts of some labels, largest first; voxels that share a corner are connected.
std::vector<std::size_t> parts(const Case& subject, const std::set<std::string>& names) {
  const std::set<std::uint8_t> wanted = values(subject, names);
  const Grid& grid = subject.labels.grid;
  std::vector<bool> seen(grid.count(), false);
  std::vector<std::size_t> sizes;
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        if (seen[grid.offset({i, j, k})] || wanted.count(subject.labels.at({i, j, k})) == 0) continue;
        std::size_t size = 0;
        std::vector<glm::ivec3> open{{i, j, k}};
        seen[grid.offset(open[0])] = true;
        while (!open.empty()) {
          const glm::ivec3 at = open.back();
          open.pop_back();
          ++size;
          for (int n = 0; n < 27; ++n) {
            const glm::ivec3 next = at + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            if (next.x < 0 || next.y < 0 || next.z < 0 || next.x >= grid.size.x || next.y >= grid.size.y ||
                next.z >= grid.size.z || seen[grid.offset(next)] || wanted.count(subject.labels.at(next)) == 0)
              continue;
            seen[grid.offset(next)] = true;
            open.push_back(next);
          }
        }
        sizes.push_back(size);
      }
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

std::size_t sum(const std::vector<std::size_t>& sizes) {
  std::size_t all = 0;
  for (const std::size_t size : sizes) all += size;
  return all;
}

}  // namespace

TEST_CASE("the liver's vessels are two trees that reach all of it, and only the portal one has a sheath") {
  const Case subject = part_of_abdomen("[-135, -105, 40]", "[80, 60, 175]");
  // A twig's label may break where it is hardly wider than a voxel.
  for (const char* tree : {"portal_vein", "hepatic_veins"}) {
    const std::vector<std::size_t> sizes =
        parts(subject, std::string(tree) == "hepatic_veins" ? std::set<std::string>{tree, "vena_cava"}
                                                            : std::set<std::string>{tree});
    INFO(tree << ": the largest of " << sizes.size() << " parts has " << sizes[0] << " of " << sum(sizes) << " voxels");
    CHECK(double(sizes[0]) > 0.93 * double(sum(sizes)));
  }

  const Grid& grid = subject.labels.grid;
  const std::set<std::uint8_t> liver = values(subject, {"liver"}), portal = values(subject, {"portal_vein"}),
                               hepatic = values(subject, {"hepatic_veins"}),
                               sheath = values(subject, {"portal_vein_wall", "bile_ducts", "vessels"});
  std::map<std::string, std::size_t> rim;  // neighbours of each tree, by what they are
  std::size_t near_portal = 0, near_hepatic = 0, places = 0;
  for (int k = 12; k + 12 < grid.size.z; ++k)
    for (int j = 12; j + 12 < grid.size.y; ++j)
      for (int i = 12; i + 12 < grid.size.x; ++i) {
        const std::uint8_t own = subject.labels.at({i, j, k});
        if (portal.count(own) != 0 || hepatic.count(own) != 0)
          for (const int step : {-1, 1}) {
            const std::uint8_t beside = subject.labels.at({i + step, j, k});
            const std::string tree = portal.count(own) != 0 ? "portal" : "hepatic";
            rim[tree + " in liver"] += liver.count(beside);
            rim[tree + " in sheath"] += sheath.count(beside);
          }
        if (own != *liver.begin() || i % 8 != 0 || j % 8 != 0 || k % 8 != 0) continue;
        ++places;
        bool is_near_portal = false, is_near_hepatic = false;
        for (int n = 0; n < 25 * 25 * 25; ++n) {
          const glm::ivec3 off(n % 25 - 12, n / 25 % 25 - 12, n / 625 - 12);
          if (off.x * off.x + off.y * off.y + off.z * off.z > 144) continue;
          const std::uint8_t there = subject.labels.at(glm::ivec3(i, j, k) + off);
          is_near_portal = is_near_portal || there == *portal.begin();
          is_near_hepatic = is_near_hepatic || there == *hepatic.begin();
        }
        near_portal += is_near_portal ? 1 : 0;
        near_hepatic += is_near_hepatic ? 1 : 0;
      }
  // Of 1 mm, the sheath is here and there thinner than a voxel.
  INFO(rim["portal in liver"] << " of " << rim["portal in sheath"]);
  CHECK(double(rim["portal in liver"]) < 0.1 * double(rim["portal in sheath"]));
  CHECK(double(rim["hepatic in sheath"]) < 0.05 * double(rim["hepatic in liver"]));
  INFO("of " << places << " places, " << near_portal << " have a branch of the portal vein within 12 mm, "
             << near_hepatic << " one of the hepatic veins");
  CHECK(double(near_portal) > 0.7 * double(places));
  CHECK(double(near_hepatic) > 0.6 * double(places));
}

TEST_CASE("a kidney has pyramids of differing size, and columns of cortex between them that reach the sinus") {
  const Case subject = part_of_abdomen("[-110, -20, 0]", "[-15, 90, 140]");
  std::vector<std::size_t> pyramids = parts(subject, {"right_kidney_medulla"});
  while (!pyramids.empty() && pyramids.back() < 100) pyramids.pop_back();  // crumbs at the edge of a papilla
  INFO(pyramids.size() << " pyramids of " << pyramids.front() << " to " << pyramids.back() << " mm^3");
  CHECK(pyramids.size() >= 8);  // Standring, Gray's Anatomy: 8 to 18
  CHECK(pyramids.size() <= 18);
  CHECK(double(pyramids.front()) > 2.0 * double(pyramids.back()));

  const Grid& grid = subject.labels.grid;
  const std::uint8_t cortex = subject.find_label("right_kidney_cortex")->value;
  const std::uint8_t medulla = subject.find_label("right_kidney_medulla")->value;
  const std::uint8_t sinus = subject.find_label("right_kidney_sinus")->value;
  std::size_t by_cortex = 0, by_medulla = 0;
  for (int k = 1; k + 1 < grid.size.z; ++k)
    for (int j = 1; j + 1 < grid.size.y; ++j)
      for (int i = 1; i + 1 < grid.size.x; ++i)
        if (subject.labels.at({i, j, k}) == sinus)
          for (const glm::ivec3& step : {glm::ivec3(1, 0, 0), glm::ivec3(0, 1, 0), glm::ivec3(0, 0, 1)})
            for (const int sign : {-1, 1}) {
              const std::uint8_t beside = subject.labels.at(glm::ivec3(i, j, k) + sign * step);
              by_cortex += beside == cortex ? 1 : 0;
              by_medulla += beside == medulla ? 1 : 0;
            }
  INFO(by_cortex << " faces of the sinus at columns, " << by_medulla << " at papillae");
  CHECK(by_cortex > 500);
  CHECK(by_medulla > 100);
}

TEST_CASE("the diaphragm is as thin as a resting one, between liver and lung") {
  const Case subject = part_of_abdomen("[-120, -40, 120]", "[-20, 40, 200]", "0.6");
  // From a point in the dome outwards, in directions in which the lung lies over the liver.
  const glm::dvec3 inside(-62, -4, 125);
  std::vector<double> thickness;
  for (double tilt = 0; tilt < 40; tilt += 4)
    for (double around = 0; around < 360; around += 20) {
      const double t = tilt * 3.14159265358979 / 180, a = around * 3.14159265358979 / 180;
      const glm::dvec3 way(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
      double first = 0, last = 0;
      std::string before, behind;
      for (double r = 20; r < 70; r += 0.1) {
        const std::string name = label_at(subject, inside + way * r);
        if (name == "diaphragm") {
          if (first == 0) first = r;
          last = r;
        } else if (first == 0) {
          before = name;
        } else if (r > last + 1) {
          behind = name;
          break;
        }
      }
      if (before == "liver" && behind == "lung") thickness.push_back(last - first);
    }
  REQUIRE(thickness.size() > 100);
  std::sort(thickness.begin(), thickness.end());
  // 1.6 +- 0.4 mm (Carrillo-Esper et al.) to 3.3 +- 1 mm (Boon et al.), see the recipe; a voxel of 0.6 mm on top.
  CHECK(thickness[thickness.size() / 2] > 1.6);
  CHECK(thickness[thickness.size() / 2] < 3.3);
  CHECK(thickness[thickness.size() / 20] > 0.8);
  CHECK(thickness[thickness.size() * 19 / 20] < 4.0);
  INFO("from " << thickness[thickness.size() / 10] << " to " << thickness[thickness.size() * 9 / 10] << " mm");
  CHECK(thickness[thickness.size() * 9 / 10] > thickness[thickness.size() / 10] + 0.8);  // not the same everywhere
}

TEST_CASE("the gallbladder's wall has two layers and is at most 3 mm thick") {
  const Case subject = part_of_abdomen("[-85, -95, 10]", "[-20, 0, 85]", "0.6");
  const glm::dvec3 middle(-54, -52, 41);
  std::vector<double> inner, outer;
  for (double a = 0; a < 360; a += 5) {
    // Across the long axis, from the fundus to the neck.
    const glm::dvec3 axis = glm::normalize(glm::dvec3(24, 52, 37));
    const glm::dvec3 u = glm::normalize(glm::cross(axis, glm::dvec3(1, 0, 0))), v = glm::cross(axis, u);
    const double angle = a * 3.14159265358979 / 180;
    const glm::dvec3 way = u * std::cos(angle) + v * std::sin(angle);
    double muscle = 0, serosa = 0;
    for (double r = 0; r < 25; r += 0.1) {
      const std::string name = label_at(subject, middle + way * r);
      muscle += name == "gallbladder_wall" ? 0.1 : 0;
      serosa += name == "gallbladder_serosa" ? 0.1 : 0;
    }
    inner.push_back(muscle);
    outer.push_back(serosa);
  }
  for (std::size_t n = 0; n < inner.size(); ++n) {
    CHECK(inner[n] > 0.5);
    CHECK(outer[n] > 0.4);
    CHECK(inner[n] + outer[n] < 3.0 + 0.6);  // a voxel
  }
}

TEST_CASE("great vessels are oval and curved, not rings along a straight line") {
  const Case subject = part_of_abdomen("[-60, -50, 0]", "[50, 40, 130]");
  const Grid& grid = subject.labels.grid;
  for (const char* vessel : {"aorta", "vena_cava"}) {
    const std::uint8_t value = subject.find_label(vessel)->value;
    std::vector<glm::dvec2> centres;
    double flattest = 1, roundest = 0;
    for (int k = 15; k < grid.size.z; k += 5) {
      double count = 0, xx = 0, yy = 0, xy = 0;
      glm::dvec2 centre(0);
      for (const int pass : {0, 1})
        for (int j = 0; j < grid.size.y; ++j)
          for (int i = 0; i < grid.size.x; ++i) {
            if (subject.labels.at({i, j, k}) != value) continue;
            const glm::dvec3 p = grid.patient_from_index(glm::dvec3(i, j, k));
            if (pass == 0) {
              centre += glm::dvec2(p.x, p.y);
              count += 1;
            } else {
              const glm::dvec2 off = glm::dvec2(p.x, p.y) - centre / count;
              xx += off.x * off.x / count;
              yy += off.y * off.y / count;
              xy += off.x * off.y / count;
            }
          }
      REQUIRE(count > 50);
      centres.push_back(centre / count);
      const double root = std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy), half = (xx + yy) / 2;
      const double ratio = std::sqrt((half - root) / (half + root));
      flattest = std::min(flattest, ratio);
      roundest = std::max(roundest, ratio);
    }
    // How far the middles lie from the straight line between the first and the last.
    double bow = 0;
    for (std::size_t n = 0; n < centres.size(); ++n) {
      const double t = double(n) / double(centres.size() - 1);
      bow = std::max(bow, glm::length(centres[n] - centres.front() * (1 - t) - centres.back() * t));
    }
    INFO(vessel << ": sections " << flattest << " to " << roundest << ", bow " << bow << " mm");
    CHECK(roundest > flattest + 0.04);
    CHECK(bow > 1);
    if (std::string(vessel) == "vena_cava") CHECK(flattest < 0.75);
  }
}

TEST_CASE("a vessel's course does not depend on a finding") {
  const Case plain = abdomen({}, "4"), fluid = abdomen({{"free_fluid", "true"}, {"liver_cyst", "true"}}, "4");
  const std::set<std::uint8_t> finding = values(plain, {"free_fluid", "liver_cyst"});
  for (const char* vessel : {"hepatic_veins", "portal_vein"}) {
    const std::uint8_t value = plain.find_label(vessel)->value;
    std::size_t moved = 0;
    for (std::size_t n = 0; n < plain.labels.voxels.size(); ++n)
      moved += plain.labels.voxels[n] != fluid.labels.voxels[n] &&
                       (fluid.labels.voxels[n] == value ||
                        (plain.labels.voxels[n] == value && finding.count(fluid.labels.voxels[n]) == 0))
                   ? 1
                   : 0;
    INFO(vessel);
    CHECK(moved == 0);
  }
}
