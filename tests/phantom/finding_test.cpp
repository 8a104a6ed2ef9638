#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/phantom/abdomen.h"

using namespace insonate;

TEST_CASE("an option changes what it names, and little else") {
  const Case plain = abdomen();
  struct Finding {
    const char* option;
    const char* label;
    double volume_ml;  // of the solid the recipe describes, near enough
    double within_ml;
  };
  for (const Finding& finding :
       {Finding{"gallstone", "gallstone", 1.1, 0.7}, Finding{"kidney_stone", "kidney_stone", 0.34, 0.3},
        Finding{"left_kidney_stone", "kidney_stone", 0.34, 0.3}, Finding{"liver_cyst", "liver_cyst", 17.2, 2},
        Finding{"free_fluid", "free_fluid", 65, 25}, Finding{"free_fluid_left", "free_fluid_left", 30, 15},
        Finding{"free_fluid_pelvis", "free_fluid_pelvis", 75, 25}}) {
    const Case found = abdomen({{finding.option, "true"}});
    const double volume = volumes_ml(found).at(finding.label);
    INFO(finding.option << " " << volume << " ml");
    CHECK(std::abs(volume - finding.volume_ml) < finding.within_ml);
    // Every voxel whose label changed became the finding, and far from it no voxel changed at all.
    const std::uint8_t value = found.find_label(finding.label)->value;
    std::size_t relabelled = 0, other = 0;
    for (std::size_t n = 0; n < plain.labels.voxels.size(); ++n)
      if (plain.labels.voxels[n] != found.labels.voxels[n]) {
        ++relabelled;
        other += found.labels.voxels[n] != value ? 1 : 0;
      }
    CHECK(relabelled > 0);
    CHECK(other == 0);
  }
}

TEST_CASE("a bladder that is less full is smaller and stays where it is tied down") {
  const auto lowest_mm = [](const Case& subject) {
    const std::uint8_t bladder = subject.find_label("bladder")->value;
    const auto first = std::find(subject.labels.voxels.begin(), subject.labels.voxels.end(), bladder);
    const auto plane =
        (first - subject.labels.voxels.begin()) / (subject.labels.grid.size.x * subject.labels.grid.size.y);
    return subject.labels.grid.patient_from_index({0, 0, double(plane)}).z;
  };
  const Case full = abdomen({}, "3"), little = abdomen({{"bladder_filling", "0.6"}}, "3");
  // Lengths of 0.6 make 0.22 of the volume, and a wall that stays as thick takes its part of that.
  const double share = volumes_ml(little).at("bladder") / volumes_ml(full).at("bladder");
  CHECK(share < 0.22);
  CHECK(share > 0.1);
  CHECK(std::abs(lowest_mm(little) - lowest_mm(full)) <= 3);  // a voxel
}

TEST_CASE("the aorta has the diameter that is asked for") {
  // The recipe with a smaller box: the aorta from L3 to the coeliac trunk.
  std::string recipe = read_file(kRecipe);
  const std::string whole = "from = [-176, -114, -194], to = [176, 124, 204]";
  REQUIRE(recipe.find(whole) != std::string::npos);
  recipe.replace(recipe.find(whole), whole.size(), "from = [-45, -75, 28], to = [50, 20, 120]");
  recipe.erase(recipe.find("\nviews = ["));  // they look from outside of that box
  for (const char* wanted : {"20", "35", "55"}) {
    const Case subject = make_phantom(kRecipe.string(), recipe, {{"aorta_diameter_mm", wanted}, {"voxel_mm", "1"}});
    const glm::dvec3 centre = subject.find_landmark("aorta_infrarenal")->position;
    // Outer to outer, as it is measured: across, between the wall's outer edges.
    const auto reach = [&](const glm::dvec3& way) {
      double r = 0;
      while (r < 60) {
        const std::string name = label_at(subject, centre + way * r);
        if (name != "aorta" && name != "aorta_wall") break;
        r += 0.25;
      }
      return r;
    };
    const double across = reach({1, 0, 0}) + reach({-1, 0, 0}), deep = reach({0, 1, 0}) + reach({0, -1, 0});
    INFO("asked for " << wanted << ", across " << across << ", deep " << deep);
    CHECK(std::abs(across - std::stod(wanted)) <= 1.0);  // a voxel
    CHECK(std::abs(deep - std::stod(wanted)) <= 1.0);
    // What does not belong to the aneurysm stays as wide as it was.
    const glm::dvec3 above = subject.find_landmark("aorta_celiac")->position;
    CHECK(label_at(subject, above + glm::dvec3(13, 0, 0)) != "aorta");
    CHECK(label_at(subject, above) == "aorta");
  }
}
