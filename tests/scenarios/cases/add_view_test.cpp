// An expert's plane, added to a case.

#include "scenarios/cases/add_view.h"

#include <catch2/catch.hpp>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/core/temporary_folder.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

struct CaseFolder {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path / "ball";

  CaseFolder() { write_case(path, tiny_case()); }
  std::string table() const { return read_file(path / "case.toml"); }
};

ReferenceView held() {
  ReferenceView view;
  view.name = "expert";
  view.title = "As the expert \"held\" it";
  view.probe = "curvilinear";
  view.depth_mm = 120;
  view.landmarks = {"centre"};
  view.targets = {"ball"};
  view.patient_from_probe = turned(3, {0, 0, 1}, {1, 2, 0.5});
  return view;
}

}  // namespace

TEST_CASE("a view is added to a case, which keeps what a person has written into it") {
  const CaseFolder subject;
  write_file(subject.path / "case.toml", "# our patient 7\n" + subject.table() + "# the end");
  add_view(subject.path, held(), tiny_tissues());
  CHECK_THAT(subject.table(), Catch::StartsWith("# our patient 7\n") && Catch::Contains("# the end\n"));
  const Case read = read_case(subject.path);
  REQUIRE(read.views.size() == 3);
  const ReferenceView &wanted = held(), &found = read.views[2];
  CHECK(found.name == wanted.name);
  CHECK(found.title == wanted.title);
  CHECK(found.probe == wanted.probe);
  CHECK(found.depth_mm == wanted.depth_mm);
  CHECK(found.landmarks == wanted.landmarks);
  CHECK(found.targets == wanted.targets);
  CHECK(found.patient_from_probe == wanted.patient_from_probe);  // to the bit
}

TEST_CASE("a view that cannot be scored is refused in a sentence, and the case stays as it was") {
  const CaseFolder subject;
  const std::string before = subject.table();
  struct Bad {
    std::function<void(ReferenceView&)> spoil;
    std::string word;
  };
  const std::vector<Bad> all = {
      {[](ReferenceView& v) { v.name = "ball"; }, "has a view of this name"},
      {[](ReferenceView& v) { v.name = "Expert's"; }, "lower-case letters"},
      {[](ReferenceView& v) { v.title = ""; }, "title"},
      {[](ReferenceView& v) { v.probe = "curvilnear"; }, "did you mean 'curvilinear'"},
      {[](ReferenceView& v) { v.depth_mm = 500; }, "depth_mm"},
      {[](ReferenceView& v) { v.targets = {"bal"}; }, "did you mean 'ball'"},
      {[](ReferenceView& v) {
         v.targets = {"ball", "rib"};
       },
       "the target 'rib' is not in its picture"},
      {[](ReferenceView& v) { v.landmarks = {"center"}; }, "did you mean 'centre'"},
      {[](ReferenceView& v) { v.depth_mm = 50; }, "the landmark 'centre' lies outside its fan"},
      {[](ReferenceView& v) { v.patient_from_probe.translation.z = 12; }, "lies 12 mm beside its plane"},
      {[](ReferenceView& v) { v.patient_from_probe.translation.y = -15; }, "is not on the skin"}};
  for (const Bad& bad : all) {
    ReferenceView view = held();
    bad.spoil(view);
    INFO(bad.word);
    CHECK_THROWS_WITH(add_view(subject.path, view, tiny_tissues()),
                      Catch::Contains(subject.path.string()) && Catch::Contains(bad.word));
    CHECK(subject.table() == before);
  }
  CHECK_THROWS_AS(add_view(subject.folder.path / "nowhere", held(), tiny_tissues()), InputError);
}
