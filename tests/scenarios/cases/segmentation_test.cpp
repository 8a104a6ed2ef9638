// Segmentations as TotalSegmentator writes them, and as they come when something went wrong on the way.

#include "scenarios/cases/segmentation.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "scenarios/cases/nifti_label_table.h"
#include "scenarios/cases/plausibility.h"
#include "sim/core/input_error.h"
#include "sim/tissue/tissue.h"
#include "tests/core/system_faults.h"
#include "tests/core/temporary_folder.h"
#include "tests/scenarios/cases/labelled_files.h"

using namespace insonate;

namespace {

const glm::ivec3 kSize(8, 6, 4);

// 8 x 6 x 4 voxels of 1 mm whose first lies at (-10, -20, 5) in RAS, which is (10, 20, 5) in LPS.
Grid ct_grid() {
  Grid grid;
  grid.size = kSize;
  grid.origin = {10, 20, 5};
  grid.direction = glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1));
  return grid;
}

const glm::dvec3 kFirst(-10, -20, 5);

int two_organs(int i, int, int) {
  return i < 3 ? 5 : i > 5 ? 1 : 0;
}

std::string mask_file(const std::function<bool(int, int, int)>& inside) {
  return label_file(kSize, kFirst, [&](int i, int j, int k) { return inside(i, j, k) ? 1 : 0; });
}

bool noted(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(), [&](const auto& n) { return n.find(words) != std::string::npos; });
}

}  // namespace

TEST_CASE("the standard label tables are TotalSegmentator's") {
  // Spot checks from the project's own class map: its first, its last, and one on either side of each row of names.
  const LabelNames total = *standard_label_table("total"), v1 = *standard_label_table("total_v1");
  CHECK(total.size() == 117);
  CHECK(v1.size() == 104);
  const std::vector<std::pair<int, std::string>> expected = {
      {1, "spleen"},         {5, "liver"},         {26, "vertebrae_S1"},
      {27, "vertebrae_L5"},  {31, "vertebrae_L1"}, {32, "vertebrae_T12"},
      {43, "vertebrae_T1"},  {44, "vertebrae_C7"}, {50, "vertebrae_C1"},
      {51, "heart"},         {52, "aorta"},        {63, "inferior_vena_cava"},
      {92, "rib_left_1"},    {103, "rib_left_12"}, {104, "rib_right_1"},
      {115, "rib_right_12"}, {116, "sternum"},     {117, "costal_cartilages"}};
  for (const auto& [value, name] : expected) CHECK(total.at(value) == name);
  const std::vector<std::pair<int, std::string>> expected_v1 = {
      {7, "aorta"},         {18, "vertebrae_L5"}, {22, "vertebrae_L1"}, {34, "vertebrae_T1"},
      {41, "vertebrae_C1"}, {42, "esophagus"},    {58, "rib_left_1"},   {69, "rib_left_12"},
      {81, "rib_right_12"}, {82, "humerus_left"}, {92, "sacrum"},       {104, "urinary_bladder"}};
  for (const auto& [value, name] : expected_v1) CHECK(v1.at(value) == name);
  CHECK_FALSE(standard_label_table("totl"));
}

TEST_CASE("every structure of the standard tables has a tissue of the tissue table") {
  const TissueTable tissues = read_tissue_table(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "tissues.toml");
  for (const std::string& table : standard_label_tables()) {
    const LabelNames names = *standard_label_table(table);
    for (const auto& [value, name] : names) {
      INFO(name);
      const auto tissue = tissue_of_structure(name);
      REQUIRE(tissue);
      CHECK(tissues.labelled.contains(*tissue));
    }
  }
  CHECK(tissue_of_structure("kidney_cyst_left") == "cyst");
  CHECK(tissue_of_structure("kidney_left") == "kidney_cortex");
  CHECK_FALSE(tissue_of_structure("wormhole"));
  // A finding is not drawn as its organ.
  CHECK(tissue_of_structure("liver_cyst") == "cyst");
  CHECK(tissue_of_structure("kidney_stone_left") == "stone");
  CHECK(tissue_of_structure("gallstone") == "stone");
  CHECK(tissue_of_structure("gallbladder_calculus") == "stone");
  CHECK(tissue_of_structure("free_fluid") == "fluid");
  CHECK(tissue_of_structure("spleen_haematoma") == "blood");
  CHECK(title_of_structure("kidney_right") == "Right kidney");
  CHECK(title_of_structure("inferior_vena_cava") == "Inferior vena cava");
}

TEST_CASE("the label table in a NIfTI header is read, packed or not") {
  const TemporaryFolder folder;
  const std::string labels = label_element("0", "background") + label_element("5", "liver") +
                             label_element("1", " spleen ") + label_element("27", "vertebrae_L5");
  const std::string bytes = label_file(kSize, kFirst, two_organs, label_extension(labels));
  const LabelNames expected = {{1, "spleen"}, {5, "liver"}, {27, "vertebrae_L5"}};
  CHECK(read_nifti_label_table(folder.put("plain.nii", bytes)) == expected);
  CHECK(read_nifti_label_table(folder.put("packed.nii.gz", gzip(bytes))) == expected);
  CHECK(read_nifti_label_table(folder.put("bare.nii", label_file(kSize, kFirst, two_organs))).empty());
  CHECK(read_nifti_label_table(folder.put("other.nrrd", nrrd(nrrd_lines(), "1234"))).empty());
  // Another program's extension before it is none of ours.
  std::string other = bytes_of_values<std::int32_t>({32, 6}) + std::string(24, 'x');
  const std::string both = label_file(kSize, kFirst, two_organs, other + label_extension(labels));
  CHECK(read_nifti_label_table(folder.put("both.nii", both)) == expected);
}

TEST_CASE("a damaged label table is refused in a sentence") {
  struct Bad {
    std::string extension, word;
  };
  const auto raw = [](std::int32_t size, std::string content) {
    content.resize(24, '\0');
    return bytes_of_values<std::int32_t>({size, 0}) + content;
  };
  const std::vector<Bad> all = {{label_extension(label_element("300", "liver")), "300"},
                                {label_extension(label_element("-1", "liver")), "'-1'"},
                                {label_extension(label_element("five", "liver")), "'five'"},
                                {label_extension(label_element("", "liver")), "''"},
                                {label_extension(label_element("5", "")), "no name"},
                                {label_extension(label_element("5", "liver") + label_element("5", "spleen")), "twice"},
                                {label_extension("<Label Key=\"5\">"), "not well-formed XML"},
                                {raw(32, "<LabelTable><Label"), "not well-formed XML"},
                                {raw(0, "<LabelTable>"), "claims 0 bytes"},
                                {raw(17, "<LabelTable>"), "claims 17 bytes"},
                                {raw(-16, "<LabelTable>"), "claims -16 bytes"},
                                {raw(2000000000, "<LabelTable>"), "claims 2000000000 bytes"}};
  const TemporaryFolder folder;
  for (const Bad& bad : all) {
    INFO(bad.extension << " " << bad.word);
    const auto file = folder.put("bad.nii", label_file(kSize, kFirst, two_organs, bad.extension));
    CHECK_THROWS_WITH(read_nifti_label_table(file),
                      Catch::Contains("bad.nii") && Catch::Contains(bad.word) && Catch::EndsWith("."));
  }
}

TEST_CASE("a file of many labels comes with its names onto the CT's grid") {
  const TemporaryFolder folder;
  const std::string extension = label_extension(label_element("1", "spleen") + label_element("5", "Liver left-lobe") +
                                                label_element("9", "aorta"));
  const auto file = folder.put("labels.nii", label_file(kSize, kFirst, two_organs, extension));
  const Segmentation read = read_segmentation(file, ct_grid());
  REQUIRE(read.table.size() == 2);  // no voxel is aorta
  CHECK(read.table[0].name == "spleen");
  CHECK(read.table[1].name == "liver_left_lobe");
  CHECK(read.table[1].value == 5);
  CHECK(read.table[1].tissue == "liver");
  CHECK(read.labels.at({0, 0, 0}) == 5);
  CHECK(read.labels.at({7, 5, 3}) == 1);
  CHECK(read.notes.empty());

  // By a standard table instead: 1 and 5 are the spleen and the liver in both.
  const auto bare = folder.put("bare.nii", label_file(kSize, kFirst, two_organs));
  CHECK(read_segmentation(bare, ct_grid(), "total_v1").table[1].name == "liver");
  CHECK(read_segmentation(file, ct_grid(), "total").table[1].name == "liver");
}

TEST_CASE("labels on another grid are resampled and what lies outside is reported") {
  const TemporaryFolder folder;
  // Voxels of 2 mm, the first covering two of the CT's each way: centres at -9.5, -19.5 and 5.5 mm. The labels go on
  // to the patient's right, which is where the CT ends: 4 x 3 x 2 of them lie in the CT, as many outside.
  const auto coarse = label_file(
      {8, 3, 2}, {-9.5, -19.5, 5.5}, [](int i, int, int) { return i < 2 || i > 3 ? 1 : 5; }, "", 2);
  const Segmentation read = read_segmentation(folder.put("coarse.nii", coarse), ct_grid(), "total");
  for (int i = 0; i < 8; ++i) CHECK(int(read.labels.at({i, 3, 2})) == (i < 4 ? 1 : 5));
  CHECK(noted(read.notes, "50.0 % of what is labelled lies outside the CT"));
}

TEST_CASE("a folder of masks becomes one label volume, and overlaps go to the smaller and are reported") {
  const TemporaryFolder folder;
  folder.put("liver.nii", mask_file([](int i, int, int) { return i < 4; }));
  folder.put("gallbladder.nii.gz", gzip(mask_file([](int i, int, int k) { return i == 3 && k == 0; })));
  folder.put("thing.nii", mask_file([](int i, int, int) { return i == 7; }));
  folder.put("urinary_bladder.nii", mask_file([](int, int, int) { return false; }));
  folder.put("statistics.json", "{}");
  double last = 0;
  const Segmentation read = read_segmentation(folder.path, ct_grid(), "", [&](double share) { last = share; });
  CHECK(last == 1);
  REQUIRE(read.table.size() == 3);
  CHECK(read.table[0].name == "gallbladder");
  CHECK(read.table[1].name == "liver");
  CHECK(read.table[2].name == "thing");
  CHECK(read.table[2].tissue == "soft_tissue");
  CHECK(read.labels.at({3, 2, 0}) == 1);
  CHECK(read.labels.at({3, 2, 1}) == 2);
  CHECK(read.labels.at({5, 2, 1}) == 0);
  CHECK(noted(read.notes, "6 voxels are claimed by 'gallbladder' and 'liver'"));
  CHECK(noted(read.notes, "'thing' is not known"));
  CHECK(noted(read.notes, "1 masks are empty"));
}

TEST_CASE("segmentations that cannot be used are refused in a sentence") {
  const TemporaryFolder folder;
  const auto path = [&](const std::string& name) { return folder.path / name; };
  const auto masks = [&](const std::string& name, const std::vector<std::pair<std::string, std::string>>& files) {
    std::filesystem::create_directories(path(name));
    for (const auto& [file, bytes] : files) folder.put(name + "/" + file, bytes);
  };
  const std::string all = mask_file([](int, int, int) { return true; });
  const std::string none = mask_file([](int, int, int) { return false; });
  const std::string names = label_extension(label_element("5", "liver"));
  folder.put("unnamed.nii", label_file(kSize, kFirst, two_organs));
  folder.put("more.nii", label_file(kSize, kFirst, two_organs, names));
  folder.put("empty.nii", label_file(
                              kSize, kFirst, [](int, int, int) { return 0; }, names));
  folder.put("away.nii", label_file(kSize, {500, 0, 0}, two_organs));
  folder.put("same.nii", label_file(kSize, kFirst, two_organs,
                                    label_extension(label_element("5", "Liver") + label_element("1", "liver"))));
  folder.put("signs.nii", label_file(kSize, kFirst, two_organs,
                                     label_extension(label_element("5", "?!") + label_element("1", "liver"))));
  masks("no_masks", {{"statistics.json", "{}"}});
  masks("empty_masks", {{"liver.nii", none}, {"spleen.nii", none}});
  masks("many_values", {{"all.nii", label_file(kSize, kFirst, two_organs)}});
  masks("away_mask", {{"liver.nii", label_file(kSize, {500, 0, 0}, [](int, int, int) { return 1; })}});
  masks("same_masks", {{"liver.nii", all}, {"Liver.nii", all}});
  masks("cut_mask", {{"liver.nii", all.substr(0, 400)}});

  struct Bad {
    std::string name, table, word;
  };
  for (const Bad& bad : std::vector<Bad>{{"nowhere.nii", "", "no such file"},
                                         {"unnamed.nii", "", "--label-table total"},
                                         {"unnamed.nii", "totl", "did you mean 'total'"},
                                         {"more.nii", "", "the value 1"},
                                         {"empty.nii", "", "no voxel is labelled"},
                                         {"away.nii", "total", "nothing of it lies within the CT"},
                                         {"same.nii", "", "two structures are called 'liver'"},
                                         {"signs.nii", "", "no letter or digit"},
                                         {"no_masks", "", "there is no mask in it"},
                                         {"no_masks", "total", "leave it out"},
                                         {"empty_masks", "", "every mask in it is empty"},
                                         {"many_values", "", "several values"},
                                         {"away_mask", "", "nothing of it lies within the CT"},
                                         {"same_masks", "", "two structures are called 'liver'"},
                                         {"cut_mask", "", "liver.nii"}}) {
    INFO(bad.name << " " << bad.table);
    CHECK_THROWS_WITH(read_segmentation(path(bad.name), ct_grid(), bad.table), Catch::Contains(bad.word));
    CHECK_THROWS_AS(read_segmentation(path(bad.name), ct_grid(), bad.table), InputError);
  }
  const NoFilesToOpen limit;
  CHECK_THROWS_WITH(read_segmentation(path("no_masks"), ct_grid()),
                    Catch::Contains("no_masks: the folder cannot be read (Too many open files); check it"));
}

TEST_CASE("a folder of masks may have 255 structures, as many as a label volume has values") {
  const TemporaryFolder folder;
  const std::string mask = mask_file([](int i, int, int) { return i == 0; });
  for (int n = 100; n < 356; ++n) folder.put("part_" + std::to_string(n) + ".nii", mask);
  CHECK_THROWS_WITH(read_segmentation(folder.path, ct_grid()),
                    Catch::Contains("part_355.nii: there are more than 255 structures; take some out of the folder"));
  std::filesystem::remove(folder.path / "part_355.nii");
  CHECK_NOTHROW(read_segmentation(folder.path, ct_grid()));
}

namespace {

struct Organ {
  std::string name, tissue;
  glm::ivec3 at;
  int hu;
};

// Cubes of 5 voxels of 4 mm, labelled as the organs; x runs to the left, y to the back, z to the head.
Case cubes(const std::vector<Organ>& organs) {
  Case subject;
  subject.ct.grid.size = {40, 40, 40};
  subject.ct.grid.spacing = glm::dvec3(4.0);
  subject.ct.voxels.assign(subject.ct.grid.count(), 40);
  subject.labels = {subject.ct.grid, std::vector<std::uint8_t>(subject.ct.grid.count())};
  for (const Organ& organ : organs) {
    const auto value = std::uint8_t(subject.label_table.size() + 1);
    subject.label_table.push_back({value, organ.name, organ.tissue});
    for (int v = 0; v < 125; ++v) {
      const glm::ivec3 i = organ.at + glm::ivec3(v % 5, v / 5 % 5, v / 25);
      subject.labels.at(i) = value;
      subject.ct.at(i) = std::int16_t(organ.hu);
    }
  }
  return subject;
}

std::vector<std::string> judged(const std::vector<Organ>& organs) {
  const Case subject = cubes(organs);
  return check_plausible("labels.nii", subject, structure_shapes(subject));
}

}  // namespace

TEST_CASE("labels that are mirrored, turned or another scan's are refused, and one odd structure is reported") {
  const std::vector<Organ> patient = {{"liver", "liver", {10, 10, 20}, 60},
                                      {"kidney_right", "kidney_cortex", {10, 20, 10}, 30},
                                      {"kidney_left", "kidney_cortex", {30, 20, 10}, 30},
                                      {"rib_right_9", "bone", {2, 20, 25}, 400},
                                      {"rib_left_9", "bone", {35, 20, 25}, 400},
                                      {"vertebrae_l2", "bone", {20, 30, 10}, 200},
                                      {"vertebrae_l1", "bone", {20, 30, 17}, 200},
                                      {"vertebrae_t12", "bone", {20, 30, 24}, 200},
                                      {"lung_lower_lobe_right", "lung", {10, 25, 34}, -800}};
  CHECK(judged(patient).empty());

  const auto changed = [&](int axis) {
    std::vector<Organ> turned = patient;
    for (Organ& organ : turned) organ.at[axis] = 35 - organ.at[axis];
    return turned;
  };
  CHECK_THROWS_WITH(judged(changed(0)),
                    Catch::Contains("labels.nii") && Catch::Contains("left and right are exchanged"));
  CHECK_THROWS_WITH(judged(changed(1)), Catch::Contains("front and back are exchanged"));
  CHECK_THROWS_WITH(judged(changed(2)), Catch::Contains("head and feet are exchanged"));
  std::vector<Organ> elsewhere = patient;
  for (Organ& organ : elsewhere)
    if (organ.tissue != "bone") organ.hu = -1000;
  CHECK_THROWS_WITH(judged(elsewhere), Catch::Contains("the labels do not lie on their organs"));
  INFO("what is soft finds its like everywhere, bones do not");
  elsewhere = patient;
  for (Organ& organ : elsewhere)
    if (organ.tissue == "bone" && organ.name != "vertebrae_l1") organ.hu = 30;
  CHECK_THROWS_WITH(judged(elsewhere), Catch::Contains("the labels do not lie on their bones"));

  INFO("one or two bones may be soft");
  std::vector<Organ> few(patient.begin(), patient.begin() + 5);
  few[3].hu = few[4].hu = 30;
  CHECK(judged(few).size() == 2);

  std::vector<Organ> odd = patient;
  odd[0].hu = -900;
  odd[3].hu = 30;
  const auto notes = judged(odd);
  REQUIRE(notes.size() == 2);
  CHECK(notes[0] == "Look at the labels: 'rib_right_9' has a median of 30 HU.");
  CHECK(notes[1] == "Look at the labels: 'liver' has a median of -900 HU.");
}
