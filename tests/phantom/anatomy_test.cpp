#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <set>

#include "tests/phantom/abdomen.h"

using namespace insonate;

namespace {

bool is_near(const Case& subject, const glm::dvec3& p, const std::set<std::string>& names, double radius_mm) {
  for (double x = -radius_mm; x <= radius_mm; x += 1)
    for (double y = -radius_mm; y <= radius_mm; y += 1)
      for (double z = -radius_mm; z <= radius_mm; z += 1)
        if (x * x + y * y + z * z <= radius_mm * radius_mm &&
            names.count(label_at(subject, p + glm::dvec3(x, y, z))) != 0)
          return true;
  return false;
}

}  // namespace

TEST_CASE("every organ of the abdomen has a volume that an adult's may have") {
  const Case subject = abdomen();
  const auto volume = volumes_ml(subject);
  struct Range {
    std::set<std::string> labels;  // counted together
    double least_ml, most_ml;
  };
  // Normal values and their sources are at the head of the recipe; where there is no norm for what the box shows of
  // an organ (bone, muscle, lung bases, bowel as full as it happens to be) the range says "there, and not everywhere".
  const std::vector<Range> ranges{
      {{"liver", "hepatic_veins", "portal_vein", "portal_vein_wall"}, 1493 - 230, 1493 + 230},
      {{"bile_ducts"}, 1, 20},
      {{"liver_ligaments"}, 1, 15},
      {{"hepatic_veins"}, 5, 60},
      {{"portal_vein"}, 8, 60},
      {{"spleen"}, 219 - 2 * 76, 219 + 2 * 76},
      {{"right_kidney_cortex", "right_kidney_medulla", "right_kidney_sinus", "right_kidney_pelvis"}, 100, 190},
      {{"left_kidney_cortex", "left_kidney_medulla", "left_kidney_sinus", "left_kidney_pelvis"}, 100, 190},
      {{"right_kidney_medulla"}, 15, 50},
      {{"left_kidney_medulla"}, 15, 50},
      {{"right_kidney_sinus"}, 8, 30},
      {{"left_kidney_sinus"}, 8, 30},
      {{"pancreas"}, 35, 110},
      {{"gallbladder"}, 15, 60},
      {{"gallbladder_wall", "gallbladder_serosa"}, 3, 20},
      {{"bladder"}, 100, 400},
      {{"bladder_wall"}, 20, 90},
      {{"stomach", "stomach_content", "stomach_gas"}, 100, 600},
      {{"stomach_gas"}, 3, 100},
      {{"bowel_wall", "bowel_content", "colon_content", "bowel_gas"}, 900, 2500},
      {{"bowel_gas"}, 50, 400},
      {{"aorta", "aorta_wall"}, 60, 200},
      {{"vena_cava", "vena_cava_wall"}, 60, 250},
      {{"subcutaneous_fat"}, 3000, 8000},
      {{"visceral_fat"}, 1500, 4500},
      {{"muscle"}, 4000, 9000},
      {{"skin"}, 400, 1000},
      {{"rib", "rib_marrow"}, 80, 400},
      {{"costal_cartilage"}, 10, 120},
      {{"spine", "spine_marrow"}, 300, 900},
      {{"disc"}, 30, 150},
      {{"pelvis", "pelvis_marrow"}, 300, 1200},
      {{"lung"}, 600, 2500},
      {{"heart"}, 100, 600},
      {{"diaphragm"}, 60, 350},
  };
  std::set<std::string> seen;
  for (const Range& range : ranges) {
    double sum = 0;
    std::string names;
    for (const std::string& name : range.labels) {
      INFO(name);
      REQUIRE(volume.count(name) == 1);
      seen.insert(name);
      sum += volume.at(name);
      names += name + " ";
    }
    INFO(names << sum << " ml");
    CHECK(sum >= range.least_ml);
    CHECK(sum <= range.most_ml);
  }
  for (const char* finding :
       {"free_fluid", "free_fluid_left", "free_fluid_pelvis", "gallstone", "kidney_stone", "liver_cyst"}) {
    INFO(finding);
    CHECK(volume.at(finding) == 0);  // only when asked for
    seen.insert(finding);
  }
  for (const char* small : {"intermuscular_fat", "spinal_canal", "vessels", "prostate"}) {
    INFO(small);
    CHECK(volume.at(small) > 5);
    seen.insert(small);
  }
  for (const Label& label : subject.label_table) {
    INFO(label.name);
    CHECK(seen.count(label.name) == 1);
  }
}

TEST_CASE("left is on the left, the head is up and the back is behind") {
  const Case subject = abdomen();
  std::map<std::string, glm::dvec3> centre;
  std::map<std::string, double> count;
  const Grid& grid = subject.labels.grid;
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        const std::uint8_t value = subject.labels.at({i, j, k});
        if (value == 0) continue;
        const std::string& name = subject.label_table[value - 1u].name;
        centre[name] += grid.patient_from_index(glm::dvec3(i, j, k));
        count[name] += 1;
      }
  for (auto& [name, sum] : centre) sum /= count[name];
  CHECK(centre["liver"].x < -30);
  CHECK(centre["gallbladder"].x < -30);
  CHECK(centre["vena_cava"].x < centre["aorta"].x);
  CHECK(centre["spleen"].x > 60);
  CHECK(centre["right_kidney_cortex"].x < -40);
  CHECK(centre["left_kidney_cortex"].x > 40);
  CHECK(centre["left_kidney_cortex"].z > centre["right_kidney_cortex"].z);
  CHECK(centre["lung"].z > centre["liver"].z);
  CHECK(centre["liver"].z > centre["bladder"].z);
  CHECK(centre["spine"].y > centre["aorta"].y);
  CHECK(centre["aorta"].y > centre["stomach"].y);
  // Gas rises: in a supine patient to the front.
  CHECK(centre["stomach_gas"].y < centre["stomach_content"].y);
  CHECK(centre["bowel_gas"].y < centre["colon_content"].y);
}

TEST_CASE("each landmark lies in what it names, or at its edge") {
  const Case subject = abdomen({}, "3");
  const std::map<std::string, std::vector<std::set<std::string>>> expected{
      {"hepatorenal_recess", {{"liver"}, {"right_kidney_cortex"}}},
      {"right_kidney_centre", {{"right_kidney_sinus", "right_kidney_pelvis"}}},
      {"right_kidney_upper_pole", {{"right_kidney_cortex"}}},
      {"right_kidney_lower_pole", {{"right_kidney_cortex"}}},
      {"left_kidney_centre", {{"left_kidney_sinus", "left_kidney_pelvis"}}},
      {"left_kidney_upper_pole", {{"left_kidney_cortex"}}},
      {"left_kidney_lower_pole", {{"left_kidney_cortex"}}},
      {"splenorenal_recess", {{"spleen"}, {"left_kidney_cortex"}}},
      {"spleen_tip", {{"spleen"}}},
      {"gallbladder_neck", {{"gallbladder", "gallbladder_wall", "gallbladder_serosa"}}},
      {"gallbladder_fundus", {{"gallbladder"}}},
      {"portal_bifurcation", {{"portal_vein"}}},
      {"hepatic_vein_confluence", {{"hepatic_veins", "vena_cava"}}},
      {"aorta_celiac", {{"aorta"}}},
      {"aorta_renal", {{"aorta"}}},
      {"aorta_infrarenal", {{"aorta"}}},
      {"aortic_bifurcation", {{"aorta"}}},
      {"aorta_distal", {{"aorta"}}},
      {"bladder_centre", {{"bladder"}}},
  };
  for (const Landmark& landmark : subject.landmarks) {
    INFO(landmark.name << " lies in " << label_at(subject, landmark.position));
    REQUIRE(expected.count(landmark.name) == 1);
    // A recess is a gap: both its sides have to be near. 7 mm: the widest gap is 5 mm, and voxels are 3 mm.
    for (const std::set<std::string>& names : expected.at(landmark.name))
      CHECK(is_near(subject, landmark.position, names, expected.at(landmark.name).size() > 1 ? 7 : 3));
  }
  CHECK(subject.landmarks.size() == expected.size());
}

TEST_CASE("each reference view holds its landmarks, and nothing hides the first of them") {
  const Case subject = abdomen({}, "3");
  constexpr double kFaceRadius = 60, kHalfAngle = 30;  // of the curvilinear probe, mm and degrees
  const std::set<std::string> opaque{"gas", "bone", "lung", "stone"};
  std::set<std::string> names;
  for (const ReferenceView& view : subject.views) {
    INFO(view.name);
    names.insert(view.name);
    CHECK(view.probe == "curvilinear");
    REQUIRE_FALSE(view.landmarks.empty());
    REQUIRE_FALSE(view.targets.empty());
    CHECK_FALSE(why_not_rigid(view.patient_from_probe.matrix()));

    // The face's middle lies under the skin: back along the beam it is 12 mm to the air.
    const Pose& pose = view.patient_from_probe;
    const auto hu_before_face = [&](double way) {
      return sample_trilinear(subject.ct, subject.ct.grid.index_from_patient(pose.point({0, -way, 0})));
    };
    CHECK(hu_before_face(12 - 3) > -300);  // the body at one voxel either side of the skin
    CHECK(hu_before_face(12 + 3) < -700);

    const Pose probe_from_patient = pose.inverse();
    for (std::size_t n = 0; n < view.landmarks.size(); ++n) {
      const Landmark* landmark = subject.find_landmark(view.landmarks[n]);
      REQUIRE(landmark != nullptr);
      const glm::dvec3 p = probe_from_patient.point(landmark->position);
      INFO(landmark->name << " at " << p.x << " " << p.y << " " << p.z);
      CHECK(std::abs(p.z) < 2);
      const double radius = std::hypot(p.x, p.y + kFaceRadius);
      const double angle = std::atan2(p.x, p.y + kFaceRadius) * 180 / 3.14159265358979;
      CHECK(std::abs(angle) < kHalfAngle);
      CHECK(radius > kFaceRadius);
      CHECK(radius < kFaceRadius + view.depth_mm);
      if (n > 0) continue;
      const glm::dvec3 line = glm::normalize(glm::dvec3(p.x, p.y + kFaceRadius, 0));
      for (double r = kFaceRadius; r < radius; r += 1) {
        const std::string name = label_at(subject, pose.point(line * r - glm::dvec3(0, kFaceRadius, 0)));
        INFO(name << " at depth " << r - kFaceRadius);
        const Label* label = subject.find_label(name);
        REQUIRE(label != nullptr);
        CHECK(opaque.count(label->tissue) == 0);
      }
    }

    // What the picture is of takes a part of it that can be seen.
    double shown = 0, all = 0;
    for (double angle = -kHalfAngle; angle < kHalfAngle; angle += 1)
      for (double r = kFaceRadius; r < kFaceRadius + view.depth_mm; r += 2) {
        const double a = angle * 3.14159265358979 / 180;
        const std::string name = label_at(subject, pose.point({r * std::sin(a), r * std::cos(a) - kFaceRadius, 0}));
        all += r;
        for (const std::string& target : view.targets) shown += name == target ? r : 0;
      }
    INFO("targets fill " << shown / all << " of the fan");
    CHECK(shown / all > 0.015);
  }
  const std::set<std::string> wanted{"hepatorenal",
                                     "splenorenal",
                                     "pelvis",
                                     "bladder_transverse",
                                     "aorta_transverse_proximal",
                                     "aorta_transverse",
                                     "aorta_transverse_distal",
                                     "aorta_long",
                                     "gallbladder_long",
                                     "right_kidney_long",
                                     "right_kidney_short",
                                     "left_kidney_long",
                                     "left_kidney_short",
                                     "liver_subcostal"};
  CHECK(names == wanted);
}

TEST_CASE("the marker points to the head in long-axis views and to the patient's right in transverse ones") {
  const Case subject = abdomen({}, "8");
  for (const ReferenceView& view : subject.views) {
    INFO(view.name);
    const glm::dvec3 marker = view.patient_from_probe.direction({1, 0, 0});
    if (view.name.find("transverse") != std::string::npos || view.name == "liver_subcostal")
      CHECK(marker.x < -0.8);
    else if (view.name == "right_kidney_short" || view.name == "left_kidney_short")
      CHECK(marker.y < -0.8);  // from the flank, the front takes the right's place on the screen
    else
      CHECK(marker.z > 0.6);
  }
}
