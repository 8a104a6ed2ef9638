#include "app/pictures/patient_look.h"

#include <catch2/catch.hpp>

#include "sim/files/files.h"
#include "sim/view/body/transfer_function_file.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

namespace {

Volume<std::int16_t> small_ct() {
  Volume<std::int16_t> ct;
  ct.grid.size = {26, 10, 10};
  ct.voxels.assign(ct.grid.count(), -1000);
  for (std::size_t i = 0; i < ct.voxels.size() / 2; ++i) ct.voxels[i] = 40;
  return ct;
}

}  // namespace

TEST_CASE("a look begins with surfaces, and what is chosen and edited is shown") {
  PatientLook look;
  CHECK(!look.shown());
  CHECK(!look.is_edited());
  look.choose(4);
  CHECK(look.shown() == look.offered()[4]);
  CHECK(!look.is_edited());
  look.move_point(1, 350, 0.5);
  CHECK(look.is_edited());
  CHECK(look.shown()->points[1].hu == 350);
  CHECK(look.shown()->points[1].opacity == 0.5);
  look.choose(4);
  CHECK(!look.is_edited());
}

TEST_CASE("a point stays between its neighbours and within the opacity that a file may have") {
  PatientLook look;
  look.choose(0);
  const double before = look.shown()->points[0].hu, after = look.shown()->points[2].hu;
  look.move_point(1, 3000, 2);
  CHECK(look.shown()->points[1].hu == after - 1);
  CHECK(look.shown()->points[1].opacity == view::kMaxOpacity);
  look.move_point(1, -3000, -1);
  CHECK(look.shown()->points[1].hu == before + 1);
  CHECK(look.shown()->points[1].opacity == 0);
}

TEST_CASE("looks that leave soft tissue clear do not hide the plane") {
  PatientLook look;
  CHECK(look.hides_plane());
  std::vector<std::string> clear;
  for (std::size_t i = 0; i < look.offered().size(); ++i) {
    look.choose(i);
    if (!look.hides_plane()) clear.push_back(look.offered()[i].name);
  }
  CHECK(clear == std::vector<std::string>{"Vessels", "Bones", "Lungs"});
}

TEST_CASE("points are added with the colour of their place, and two always stay") {
  PatientLook look;
  look.choose(0);
  const glm::dvec3 colour = look.shown()->at(-300).colour;
  const std::optional<std::size_t> added = look.add_point(-300, 0.25);
  REQUIRE(added == 2u);
  CHECK(look.shown()->points[2].hu == -300);
  CHECK(look.shown()->points[2].opacity == 0.25);
  CHECK(look.shown()->points[2].colour == colour);
  for (int i = 0; i < 10; ++i) look.remove_point(0);
  CHECK(look.shown()->points.size() == 2);
  for (int i = 0; i < 100; ++i) look.add_point(-500 + 7 * i, 0);
  CHECK(look.shown()->points.size() == view::kMaxTransferPoints);
}

TEST_CASE("shift and scale move all points from where they were edited last") {
  PatientLook look;
  look.choose(4);
  const view::TransferFunction bones = *look.shown();
  look.shift(50);
  look.shift(100);
  look.scale(0.5);
  CHECK(look.shown() == bones.moved(100, 0.5));
  look.shift(0);
  look.scale(1);
  CHECK(look.shown() == bones);
}

TEST_CASE("a saved look is offered from then on, also to the next start, and leaves the bundled one as it was") {
  const TemporaryFolder home;
  const std::filesystem::path folder = home.path / "looks";
  PatientLook look;
  CHECK(look.use_folder(folder).empty());
  const std::size_t bundled = look.offered().size();
  look.choose(4);
  look.move_point(1, 350, 0.5);
  const view::TransferFunction edited = *look.shown();
  look.save();
  CHECK(look.offered().size() == bundled + 1);
  CHECK(look.chosen() == bundled);
  CHECK(look.offered()[4].name == "Bones");
  CHECK(look.offered().back().name == "Bones (edited)");
  look.save();
  CHECK(look.offered().size() == bundled + 1);

  PatientLook next;
  CHECK(next.use_folder(folder).empty());
  REQUIRE(next.offered().size() == bundled + 1);
  CHECK(next.offered().back().points == edited.points);
}

TEST_CASE("a look from a file is saved to that file, and names in another script get files of their own") {
  const TemporaryFolder home;
  const std::filesystem::path first = home.path / "mine.toml";
  view::write_transfer_function(first, {"\u9aa8", {{0, {}, 0}, {100, {}, 0.5}}});
  PatientLook look;
  look.use_folder(home.path);
  const std::size_t mine = look.offered().size() - 1;
  look.choose(mine);
  look.move_point(1, 200, 0.5);
  CHECK(look.save() == first);
  look.take({"\u808c", {{0, {}, 0}, {50, {}, 0.5}}});
  CHECK(look.save() != first);
  PatientLook next;
  CHECK(next.use_folder(home.path).empty());
  REQUIRE(next.offered().size() == mine + 2);
  CHECK(std::any_of(next.offered().begin(), next.offered().end(),
                    [](const auto& offered) { return offered.name == "\u9aa8" && offered.points[1].hu == 200; }));
}

TEST_CASE("a file in the person's folder that cannot be used is reported, and the others are offered") {
  const TemporaryFolder home;
  home.put("a.toml", "name = \"A\"\n");
  view::write_transfer_function(home.path / "b.toml", {"B", {{0, {}, 0}, {1, {}, 0.5}}});
  PatientLook look;
  const std::vector<std::string> problems = look.use_folder(home.path);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].find("a.toml") != std::string::npos);
  CHECK(look.offered().back().name == "B");
}

TEST_CASE("each patient is shown again as they were left") {
  const TemporaryFolder home;
  {
    PatientLook look;
    look.use_folder(home.path);
    look.begin("Anna", small_ct());
    look.choose(4);
    look.move_point(1, 350, 0.5);
    look.keep();
    look.begin("Berta", small_ct());
    CHECK(!look.shown());
  }
  PatientLook look;
  look.use_folder(home.path);
  look.begin("Anna", small_ct());
  REQUIRE(look.shown());
  CHECK(look.shown()->points[1].hu == 350);
  CHECK(look.chosen() == 4u);
  CHECK(look.is_edited());
  look.choose(std::nullopt);
  look.keep();
  look.begin("Anna", small_ct());
  CHECK(!look.shown());
}

TEST_CASE("the histogram has its peaks where the CT's values are") {
  PatientLook look;
  look.begin("Anna", small_ct());
  const auto at = [&](int hu) {
    return look.histogram()[std::size_t((hu - view::kFirstTransfer_hu) / PatientLook::kBin_hu)];
  };
  CHECK(at(40) > 0.9);
  CHECK(at(-1000) > 0.9);
  CHECK(at(500) == 0);
}

TEST_CASE("a look offers the structures that have a colour, bones last, and each is switched by itself") {
  PatientLook look;
  const std::vector<Label> labels{{1, "skin", "skin"},
                                  {2, "rib_left_7", "bone"},
                                  {4, "liver", "liver"},
                                  {9, "right_kidney_cortex", "kidney_cortex"}};
  std::vector<std::string> names(256);
  for (const Label& label : labels) names[label.value] = label.name;
  look.offer(labels, view::colours_of_organs(names));
  const auto titles = [&] {
    std::vector<std::string> offered;
    for (const StructureChoice& structure : look.structures()) offered.push_back(structure.title);
    return offered;
  };
  CHECK(titles() == std::vector<std::string>{"liver", "right kidney cortex", "rib left 7"});
  CHECK(look.shown_structures().empty());
  look.show_structure(1, true);
  look.show_structure(2, true);
  CHECK(look.shown_structures() == std::vector<std::uint8_t>{9, 2});
  look.show_structure(2, false);
  look.choose(4);  // through bones the plane is seen, but not behind a structure
  CHECK(look.hides_plane());
  look.choose(0);  // another look keeps them
  CHECK(look.shown_structures() == std::vector<std::uint8_t>{9});
  look.offer({}, {});  // another patient does not
  CHECK(look.structures().empty());
  CHECK(look.shown_structures().empty());
}
