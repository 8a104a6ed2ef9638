// insonate-case as a person runs it.
#include <catch2/catch.hpp>

#include <algorithm>

#include "sim/volume/case.h"
#include "tests/tools/case/case_workplace.h"
#include "tests/volume/dicom_files.h"

using namespace insonate;
namespace fs = std::filesystem;
using Json = nlohmann::json;

TEST_CASE("insonate-case phantom makes the recipe's case and says how far it is") {
  const Workplace place;
  const ProgramOutcome outcome = place.make(place.made, "--set radius_mm=3");
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.output.empty());
  CHECK(contains(outcome.errors, "Making the phantom: 100 %\n"));
  // A log file gets a line for every tenth, not for every hundredth.
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') <= 11);
  const Case ball = read_case(place.made);
  CHECK(ball.name == "Ball");
  const auto inside = std::count(ball.labels.voxels.begin(), ball.labels.voxels.end(), 1);
  CHECK(double(inside) == Approx(4 / 3.0 * 3.1416 * 7 * 7 * 3).epsilon(0.1));  // six voxels across: edges count

  // An older case gives way to --replace alone.
  place.refused("phantom --recipe " + place.recipe.string() + " " + place.made.string(),
                {place.made.string(), "there is a case already", "--replace"});
  CHECK(read_case(place.made).labels.voxels == ball.labels.voxels);
  REQUIRE(place.make(place.made, "--replace").code == 0);
  const Case larger = read_case(place.made);
  CHECK(std::count(larger.labels.voxels.begin(), larger.labels.voxels.end(), 1) > inside);
}

TEST_CASE("insonate-case phantom refuses a folder before the work, and a bad recipe or option in a sentence") {
  const Workplace place;
  const fs::path thesis = place.folder.path / "thesis";
  fs::create_directories(thesis);
  write_file(thesis / "chapter.tex", "years of work");
  const auto refused = [&](const std::string& arguments, const std::vector<std::string>& words) {
    place.refused("phantom " + arguments, words);
  };
  const std::string recipe = "--recipe " + place.recipe.string() + " ";
  // Not a line of progress: refused() counts the lines.
  refused(recipe + thesis.string(), {thesis.string(), "something that is not a case is in the way"});
  refused(recipe + thesis.string() + "/", {"something that is not a case is in the way"});
  refused(recipe + (thesis / "chapter.tex" / "case").string(), {"the folder cannot be made"});
  refused(recipe + "/proc/none/case", {"the folder cannot be made"});
  refused(recipe + ".", {"it is not the name of a folder"});
  CHECK(read_file(thesis / "chapter.tex") == "years of work");

  const std::string to = place.made.string();
  refused("--recipe /nowhere.toml " + to, {"/nowhere.toml"});
  refused(recipe + "--set radius_mm " + to, {"write KEY=VALUE"});
  refused(recipe + "--set radius=3 " + to, {"radius_mm"});
  refused(recipe + "--set radius_mm=30 " + to, {"radius_mm"});
  CHECK_FALSE(fs::exists(place.made));
}

TEST_CASE("insonate-case inspect reports what a case holds") {
  const Workplace place;
  REQUIRE(place.make(place.made).code == 0);
  const Json about = place.inspect(place.made);
  CHECK(about["format"] == "case");
  CHECK(about["name"] == "Ball");
  CHECK(about["size"] == Json({24, 20, 20}));
  CHECK(about["orientation"] == "LPS");
  CHECK(about["hu"]["most"] == 60);
  CHECK(about["hu"]["least"] == -1000);
  CHECK(about["labels"][0]["name"] == "ball");
  CHECK(about["labels"][0]["volume_ml"].get<double>() == Approx(about["labels"][0]["voxels"].get<double>() / 1000));
  CHECK(about["landmarks"][0]["position_mm"] == Json({12, 10, 8}));
  CHECK(about["views"][0]["patient_from_probe"].size() == 16);

  const ProgramOutcome words = place.run("inspect " + place.made.string());
  CHECK(words.code == 0);
  for (const char* part : {"24 x 20 x 20 voxels", "i to the left, j to the back, k to the head", "From the front"})
    CHECK(contains(words.output, part));
}

TEST_CASE("insonate-case inspect reports what a CT file holds") {
  const Workplace place;
  REQUIRE(place.make(place.made).code == 0);
  const Json about = place.inspect(place.made / "ct.nrrd");
  CHECK(about["format"] == "NRRD");
  CHECK(about["stored_as"] == "int16");
  CHECK(about["clamped_voxels"] == 0);
  CHECK(about["size"] == Json({24, 20, 20}));
  CHECK_FALSE(about.contains("labels"));
}

TEST_CASE("insonate-case inspect reports what a DICOM folder holds, and the series that it left") {
  const Workplace place;
  const fs::path folder = place.folder.path / "dicom";
  fs::create_directories(folder);
  DicomSlice slice;
  slice.stored.assign(std::size_t(slice.columns) * std::size_t(slice.rows), 1084);  // 60 HU
  slice.stored[0] = 24;                                                             // air
  for (int k = 0; k < 5; ++k) {
    slice.position = {-20, -30, 100 + 5.0 * k};
    write_dicom(folder / ("a" + std::to_string(k) + ".dcm"), slice);
  }
  slice.series = "1.2.3.5";
  slice.description = "SCOUT";
  for (int k = 0; k < 2; ++k) {
    slice.position = {-20, -30, 100.0 + k};
    write_dicom(folder / ("b" + std::to_string(k) + ".dcm"), slice);
  }
  const Json about = place.inspect(folder);
  CHECK(about["format"] == "DICOM series");
  CHECK(about["size"] == Json({8, 6, 5}));
  CHECK(about["spacing_mm"][2].get<double>() == Approx(5));
  CHECK(about["hu"]["percentiles"]["50"] == 60);
  REQUIRE(about["other_series"].size() == 1);
  CHECK(contains(about["other_series"][0].get<std::string>(), "SCOUT"));
  CHECK(contains(place.run("inspect " + folder.string()).output, "SCOUT"));
}

TEST_CASE("insonate-case inspect refuses in a sentence what it cannot read, and exits with 2") {
  const Workplace place;
  REQUIRE(place.make(place.made).code == 0);
  const std::string whole = read_file(place.made / "ct.nrrd");
  const std::string cut = place.folder.put("cut.nrrd", whole.substr(0, whole.size() / 2)).string();
  const std::string header = place.folder.put("header.nrrd", whole.substr(0, 20)).string();
  fs::create_directories(place.folder.path / "nothing");
  const std::string table = read_file(place.made / "case.toml");
  fs::create_directories(place.folder.path / "cut_case");
  place.folder.put("cut_case/case.toml", table.substr(0, table.size() / 2));
  place.refused("inspect /nowhere/scan.nii.gz", {"/nowhere/scan.nii.gz"});
  place.refused("inspect " + cut, {"cut.nrrd"});
  place.refused("inspect " + header, {"header.nrrd"});
  place.refused("inspect --json " + cut, {"cut.nrrd"});
  place.refused("inspect " + (place.folder.path / "nothing").string(), {"nothing"});
  place.refused("inspect " + (place.folder.path / "cut_case").string(), {"case.toml"});
  place.refused("inspect " + place.recipe.string(), {"ball.toml"});

  CHECK(place.run("").code == 2);
  CHECK(place.run("inspct " + place.made.string()).code == 2);
  CHECK(place.run("inspect").code == 2);
  CHECK(place.run("--help").code == 0);
}
