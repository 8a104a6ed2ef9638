#include "sim/volume/case.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstring>
#include <fstream>
#include <functional>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/volume/ct_reader.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

Case small_case() {
  Case subject;
  subject.name = "A \"small\" case\nof \\ two lines";
  Grid& grid = subject.ct.grid;
  grid.size = {5, 4, 3};
  grid.spacing = {1, 1.5, 2.25};
  grid.origin = {-10.1, 20.2, 30.3};
  grid.direction = glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0));
  for (std::size_t v = 0; v < grid.count(); ++v) subject.ct.voxels.push_back(std::int16_t(int(v) * 50 - 1000));
  subject.labels = {grid, std::vector<std::uint8_t>(grid.count(), 0)};
  subject.labels.at({2, 2, 1}) = 7;
  subject.labels.at({3, 2, 1}) = 255;
  subject.label_table = {{7, "liver", "liver"}, {255, "right_kidney_cortex", "kidney_cortex"}};
  subject.landmarks = {{"hepatorenal_recess", {1.0 / 3, -2e-7, 123456.0 / 7}}};
  ReferenceView view;
  view.name = "hepatorenal";
  view.title = "Right upper quadrant, hépatorenal recess";
  view.probe = "curvilinear";
  view.depth_mm = 160;
  view.landmarks = {"hepatorenal_recess"};
  view.targets = {"liver", "right_kidney_cortex"};
  view.patient_from_probe.rotation = glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))));
  view.patient_from_probe.translation = {-120.5, 3, 17};
  subject.views = {view};
  return subject;
}

double most_apart(const glm::dmat4& a, const glm::dmat4& b) {
  double worst = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) worst = std::max(worst, std::abs(a[c][r] - b[c][r]));
  return worst;
}

std::string why_refused(const fs::path& folder) {
  try {
    read_case(folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("a case comes back from its folder as it was written") {
  const TemporaryFolder folder;
  const Case written = small_case();
  write_case(folder.path / "deep" / "case", written);
  const Case read = read_case(folder.path / "deep" / "case");
  CHECK(read.name == written.name);
  CHECK(read.ct.voxels == written.ct.voxels);
  CHECK(read.labels.voxels == written.labels.voxels);
  CHECK(read.ct.grid.size == written.ct.grid.size);
  CHECK(most_apart(read.ct.grid.matrix(), written.ct.grid.matrix()) < 1e-9);
  REQUIRE(read.find_label("right_kidney_cortex"));
  CHECK(read.find_label("right_kidney_cortex")->value == 255);
  CHECK(read.find_label("right_kidney_cortex")->tissue == "kidney_cortex");
  REQUIRE(read.find_landmark("hepatorenal_recess"));
  CHECK(read.find_landmark("hepatorenal_recess")->position == written.landmarks[0].position);
  REQUIRE(read.find_view("hepatorenal"));
  const ReferenceView& view = *read.find_view("hepatorenal");
  CHECK(view.title == written.views[0].title);
  CHECK(view.targets == written.views[0].targets);
  CHECK(view.landmarks == written.views[0].landmarks);
  CHECK(view.depth_mm == 160);
  CHECK(most_apart(view.patient_from_probe.matrix(), written.views[0].patient_from_probe.matrix()) < 1e-12);
  CHECK(read.find_view("other") == nullptr);
}

TEST_CASE("a case's numbers come back to the bit, the sign of zero too") {
  const TemporaryFolder folder;
  Case written = small_case();
  Pose& pose = written.views[0].patient_from_probe;
  pose = {glm::dmat3(1.0), {-0.0, 1.0 / 3, 160}};
  pose.rotation[0].y = -0.0;
  written.landmarks[0].position.z = -0.0;
  write_case(folder.path / "case", written);
  const Case read = read_case(folder.path / "case");
  const Pose& back = read.views[0].patient_from_probe;
  const auto same = [](const glm::dvec3& a, const glm::dvec3& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  CHECK(same(back.translation, pose.translation));
  for (int c = 0; c < 3; ++c) CHECK(same(back.rotation[c], pose.rotation[c]));
  CHECK(same(read.landmarks[0].position, written.landmarks[0].position));
}

TEST_CASE("a case may be of any size and density, a person's CT may not") {
  const TemporaryFolder folder;
  Case subject = small_case();
  std::fill(subject.ct.voxels.begin(), subject.ct.voxels.end(), std::int16_t(0));
  write_case(folder.path / "case", subject);
  CHECK(read_case(folder.path / "case").ct.voxels == subject.ct.voxels);
  CHECK_THROWS_WITH(read_ct(folder.path / "case" / "ct.nrrd"), Catch::Contains("is its spacing in mm"));
}

TEST_CASE("a view goes to the end of a case's table, and one that cannot be read again does not") {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "case", table = path / "case.toml";
  const Case subject = small_case();
  write_case(path, subject);
  folder.put("case/case.toml", read_file(table) + "# a remark");  // without an end of line
  ReferenceView view = subject.views[0];
  CHECK_THROWS_WITH(append_view(path, view), Catch::Contains("the name 'hepatorenal' is taken"));
  view.name = "second";
  append_view(path, view);
  CHECK(read_file(table).find("# a remark\n") != std::string::npos);
  const Case read = read_case(path);
  REQUIRE(read.views.size() == 2);
  CHECK(read.views[1].name == "second");
  view.name = "third";
  view.targets = {"spleen"};
  const std::string before = read_file(table);
  CHECK_THROWS_WITH(append_view(path, view), Catch::Contains("no label is called 'spleen'"));
  CHECK(read_file(table) == before);
}

TEST_CASE("a case whose folder cannot be made is refused, and the longest name that can be made is replaced too") {
  const TemporaryFolder folder;
  Case subject = small_case();
  // File systems take names of 255 bytes, and beside the folder goes ".NAME.ID.partial" with 16 digits.
  const std::size_t longest = 255 - (2 + 16 + std::string(".partial").size());
  const auto of_length = [&](std::size_t length) { return folder.path / std::string(length, 'c'); };
  CHECK_THROWS_WITH(write_case(of_length(longest + 1), subject),
                    Catch::Contains("the folder cannot be made (File name"));
  write_case(of_length(longest), subject);
  subject.name = "newer";
  write_case(of_length(longest), subject);
  CHECK(read_case(of_length(longest)).name == subject.name);
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

TEST_CASE("a case without labels is a case") {
  const TemporaryFolder folder;
  Case subject = small_case();
  subject.labels = {};
  subject.label_table.clear();
  subject.views[0].targets.clear();
  write_case(folder.path / "case", subject);
  const Case read = read_case(folder.path / "case");
  CHECK(read.labels.empty());
  CHECK(read.views.size() == 1);
}

TEST_CASE("a case replaces an older one whole, and nothing that is not a case") {
  const TemporaryFolder folder;
  Case subject = small_case();
  write_case(folder.path / "case/", subject);
  write_file(folder.path / "case" / "stale", "from the older case");
  subject.name = "newer";
  write_case(folder.path / "case/", subject);
  CHECK(read_case(folder.path / "case").name == "newer");
  CHECK_FALSE(fs::exists(folder.path / "case" / "stale"));
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);

  write_file(folder.path / "thesis" / "chapter.tex", "years of work");
  CHECK_THROWS_AS(write_case(folder.path / "thesis", subject), InputError);
  CHECK(read_file(folder.path / "thesis" / "chapter.tex") == "years of work");
  CHECK_THROWS_AS(write_case("/proc/none/case", subject), InputError);
  CHECK_THROWS_WITH(write_case(folder.path / std::string(300, 'c') / "case", subject),
                    Catch::Contains("/case: the folder cannot be made (File name too long); name a folder"));
  fs::create_symlink("nowhere", folder.path / "link");
  CHECK_THROWS_WITH(write_case(folder.path / "link", subject),
                    Catch::Contains("/link: it cannot be written (Not a directory); name a folder"));
  fs::remove(folder.path / "link");

  // The same is said without a case, and nothing is left behind.
  for (const fs::path& taken : {folder.path / "thesis", folder.path / "thesis" / "chapter.tex" / "case",
                                fs::path("/proc/none/case"), fs::path("."), folder.path / ".."})
    CHECK_THROWS_AS(check_case_can_be_written(taken), InputError);
  check_case_can_be_written(folder.path / "case/");
  check_case_can_be_written(folder.path / "deep" / "new");
  CHECK_FALSE(fs::exists(folder.path / "deep"));

  // What read_case would refuse is not written at all.
  subject.views[0].landmarks = {"nowhere"};
  CHECK_THROWS_AS(write_case(folder.path / "case", subject), InputError);
  CHECK(read_case(folder.path / "case").name == "newer");
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 2);
}

TEST_CASE("a case that cannot be used is refused with the place and the reason") {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "case";
  write_case(path, small_case());
  const std::string good = read_file(path / "case.toml");
  const struct {
    const char *what, *by, *sentence;
  } cases[] = {
      {"format = 1", "format = 2", "line 2, column 10: the case has format 2"},
      {"format = 1", "", "the key 'format' is missing"},
      {"format = 1", "format = 1\nlables = \"x\"", "did you mean 'labels'?"},
      {"name = \"A", "nam = \"A", "the key 'name' is missing; add it: a text between quotation marks, or rename 'nam'"},
      {"ct = \"ct.nrrd\"", "ct = \"../ct.nrrd\"", "name a file in the case's folder"},
      {"ct = \"ct.nrrd\"", "ct = \"/etc/passwd\"", "name a file in the case's folder"},
      {"ct = \"ct.nrrd\"", "ct = \"other.nrrd\"", "there is no such file"},
      {"ct = \"ct.nrrd\"", "ct = \"case.toml\"", "does not end as a volume's does"},
      {"ct = \"ct.nrrd\"", "ct = 3", "'ct' is not a text"},
      {"labels = \"labels.nrrd\"", "", "there are labels but no label volume"},
      {"labels = \"labels.nrrd\"", "labels = \"ct.nrrd\"", "not a whole number from 0 to 255"},
      {"value = 7", "value = 8", "holds the value 7, which no [[label]] names"},
      {"value = 7", "value = 0", "label 1: 'value' is 0"},
      {"value = 7", "value = 256", "'value' is 256"},
      {"value = 7", "value = 255", "label 2: the value is taken by another label"},
      {"name = \"liver\"", "name = \"right_kidney_cortex\"", "label 2: the name 'right_kidney_cortex' is taken"},
      {"name = \"liver\"", "name = \"Liver\"", "use lower-case letters"},
      {"name = \"liver\"", "name = \"\"", "'name' is empty"},
      {"tissue = \"liver\"", "tissues = \"liver\"", "rename 'tissues' if it is meant"},
      {"[[landmark]]", "[[landmarks]]", "did you mean 'landmark'?"},
      {"position = [", "position = [1, ", "'position' has 4 numbers"},
      {"position = [", "position = [nan, ", "holds nan"},
      {"position = [", "position = [1e9, 0, 0] #", "holds 1000000000; write 3 numbers from -100000 to 100000"},
      {"landmarks = [\"hepatorenal_recess\"]", "landmarks = [\"hepatorenal_reces\"]",
       "no landmark is called 'hepatorenal_reces'; did you mean 'hepatorenal_recess'?"},
      {"targets = [\"liver\"", "targets = [\"livr\"", "no label is called 'livr'; did you mean 'liver'?"},
      {"targets = [\"liver\"", "targets = [3", "'targets' holds something that is not a text"},
      {"depth_mm = 160.0", "depth_mm = 1600", "'depth_mm' is 1600; give a number from 20 to 300"},
      {"probe = \"curvilinear\"", "", "the key 'probe' is missing"},
      {"patient_from_probe = [\n  0.", "patient_from_probe = [\n  1.", "view 1: the rotation is not orthonormal"},
      {"patient_from_probe = [\n  0.", "patient_from_probe = [\n  -0.", "the rotation"},
      {"  0.0, 0.0, 0.0, 1.0,", "  0, 0, 0, 2,", "last row is not 0 0 0 1"},
      {"  0.0, 0.0, 0.0, 1.0,", "  0, 0, 0,", "'patient_from_probe' has 15 numbers"},
      {"[[view]]", "[view]", "not a list of tables"},
      {"[[view]]", "[[view", "this is not TOML"},
  };
  for (const auto& bad : cases) {
    folder.put("case/case.toml", replaced(good, bad.what, bad.by));
    const std::string why = why_refused(path);
    INFO(bad.by << " -> " << why);
    CHECK(why.find(bad.sentence) != std::string::npos);
    CHECK(why.find(path.string()) == 0);
  }
  folder.put("case/case.toml", good);
  CHECK(why_refused(path).empty());
  CHECK(why_refused(folder.path / "none").find("there is no such folder") != std::string::npos);
  CHECK(why_refused(folder.path).find("there is no such file") != std::string::npos);
}

TEST_CASE("labels that lie elsewhere than the CT are refused") {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "case";
  const Case subject = small_case();
  const auto with_grid = [&](const std::function<void(Grid&)>& change) {
    write_case(path, subject);
    Volume<std::uint8_t> labels = subject.labels;
    change(labels.grid);
    labels.voxels.resize(labels.grid.count());
    write_labels(path / "labels.nrrd", labels);
    return why_refused(path);
  };
  CHECK(with_grid([](Grid& grid) { grid.origin.x += 0.01; }).empty());
  CHECK(with_grid([](Grid& grid) { grid.origin.x += 1; }).find("lie elsewhere") != std::string::npos);
  CHECK(with_grid([](Grid& grid) { grid.spacing.y *= 1.2; }).find("lie elsewhere") != std::string::npos);
  CHECK(with_grid([](Grid& grid) { grid.direction[0] = -grid.direction[0]; }).find("lie elsewhere") !=
        std::string::npos);
  CHECK(with_grid([](Grid& grid) { grid.size.z = 4; }).find("other sizes") != std::string::npos);
}

TEST_CASE("a case table cut anywhere or with any byte changed is read or refused") {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "case";
  write_case(path, small_case());
  const std::string good = read_file(path / "case.toml");
  std::uint32_t state = 1;
  const auto random = [&](std::uint32_t below) { return (state = state * 1664525u + 1013904223u) / 65536u % below; };
  int refused = 0;
  for (int round = 0; round < 600; ++round) {
    std::string bytes = good;
    if (round < 100) {
      bytes.resize(std::max<std::size_t>(1, good.size() * std::size_t(round) / 100));
    } else {
      for (int flips = 1 + int(random(3)); flips > 0; --flips)
        bytes[random(std::uint32_t(bytes.size()))] = char(random(256));
    }
    folder.put("case/case.toml", bytes);
    try {
      read_case(path);
    } catch (const InputError&) {
      ++refused;
    }
  }
  CHECK(refused > 300);
  CHECK(refused < 600);
}
