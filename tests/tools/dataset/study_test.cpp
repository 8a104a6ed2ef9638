#include "tools/dataset/study.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <functional>
#include <set>

#include "sim/core/input_error.h"
#include "sim/model/settings_file.h"
#include "tests/tools/dataset/study_folder.h"
#include "tools/dataset/draws.h"
#include "tools/dataset/patients.h"
#include "tools/dataset/setting_ranges.h"

using namespace insonate;

namespace {

const char* const kHead = "format = 1\nname = \"n\"\nseed = 3\nimages = 100\nshard_images = 10\n";
const char* const kTail = "[[case]]\ncase = \"abdomen\"\n[[probe]]\nname = \"linear\"\n[[poses]]\nkind = \"skin\"\n";

Study read(const std::string& text) {
  const test::StudyFolder folder;
  return read_study(folder.file("study.toml", text));
}

std::string why_refused(const std::function<void()>& use) {
  try {
    use();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a study reads back as it was written") {
  const Study study = read(R"(
format = 1
name = "livers"
seed = 4294967295
images = 1001
shard_images = 250

[settings]
gain_db = [-6, 6]
samples = 512
beam_lines = [5, 9]
edge_shadow = "either"
grey_map = ["linear", "soft"]
tgc_db = [0, 1, 2, 3, 4, 5, 6, 7]
tgc_shift_db = [-2, 3]

[[case]]
case = "abdomen"
name = "phantom"
weight = 3
patients = 4
phantom = { gallstone = "either", aorta_diameter_mm = [18, 50], voxel_mm = 2, free_fluid = true }

[[probe]]
name = "curvilinear"
weight = 2
lines = 128
depth_mm = [100, 200]
depth_step_mm = 20
frequency_mhz = 4

[[poses]]
kind = "view"
weight = 5
cases = ["phantom"]
probes = ["curvilinear"]
views = ["hepatorenal"]
tilt_deg = [-5, 10]
press_mm = 2
slide_mm = 7

[[poses]]
kind = "log"
file = ")" INSONATE_ASSETS_FOLDER R"(/logs/ruq_good.igs.mha"
transform = "ProbeToPatient"

[[poses]]
kind = "skin"
around_deg = [-90, 0]
height_percent = [20, 60]
)");
  CHECK(study.name == "livers");
  CHECK(study.seed == 4294967295u);
  CHECK(study.shards() == 5);
  CHECK(study.images_of(3) == 250);
  CHECK(study.images_of(4) == 1);
  CHECK(study.first_image(4) == 1000);
  CHECK(study.digest.size() == 16);
  REQUIRE(study.cases.size() == 1);
  CHECK(study.cases[0].name == "phantom");
  CHECK(study.cases[0].licence == "Apache-2.0, made by Insonate");
  CHECK(study.cases[0].options.size() == 4);
  REQUIRE(study.probes.size() == 1);
  CHECK(study.probes[0].probe.lines == 128);
  CHECK(study.probes[0].depth_mm.step == 20);
  CHECK(study.probes[0].frequency_mhz.range.least == 4);
  CHECK(study.probes[0].frequency_mhz.range.most == 4);
  REQUIRE(study.poses.size() == 3);
  CHECK(study.poses[0].kind == PoseKind::view);
  CHECK(study.poses[0].tilt_deg.most == 10);
  CHECK(study.poses[0].rock_deg.most == 0);
  CHECK(study.poses[0].press_mm.least == 2);
  CHECK(study.poses[1].log.filename() == "ruq_good.igs.mha");
  CHECK(study.poses[2].around_deg.most == 0);
  CHECK(study.poses[2].tilt_deg.least == -20);
}

TEST_CASE("what is wrong with a study is refused with its place, and what to do") {
  const std::string head = kHead, tail = kTail;
  const struct {
    std::string text, place, problem;
  } cases[] = {
      {"= 3", "line 1", "TOML"},
      {head + "seeed = 4\n" + tail, "line 6, column 1", "the key 'seeed' is unknown here; did you mean 'seed'?"},
      {"format = 2\nname = \"n\"\nseed = 3\nimages = 1\n" + tail, "line 1", "'format' is 2"},
      {"format = 1\nseed = 3\nimages = 1\n" + tail, "", "'name' is missing"},
      {"format = 1\nname = \"n\"\nseed = -1\nimages = 1\n" + tail, "line 3", "'seed' is -1"},
      {"format = 1\nname = \"n\"\nseed = 1\nimages = 0\n" + tail, "line 4", "'images' is 0"},
      {"format = 1\nname = \"n\"\nseed = 1\nimages = 1000000\nshard_images = 1\n" + tail, "line 5",
       "there would be 1000000 shards, above 100000"},
      {head + "[settings]\ngain_db = [6, -6]\n" + tail, "line 7",
       "'gain_db' begins with its larger number; write [-6, 6]"},
      {head + "[settings]\ngain_db = [-61, 6]\n" + tail, "line 7", "'gain_db' is -61, not a number from -60 to 60"},
      {head + "[settings]\ngain_db = true\n" + tail, "line 7", "'gain_db'"},
      {head + "[settings]\nsamples = [100.5, 200]\n" + tail, "line 7", "'samples' is not a range of whole numbers"},
      {head + "[settings]\nsamples = 1.5\n" + tail, "line 7", "'samples' is not a whole number"},
      {head + "[settings]\nbeam_lines = [4, 8]\n" + tail, "line 7", "'beam_lines' is 4, not an odd number"},
      {head + "[settings]\nedge_shadow = \"maybe\"\n" + tail, "line 7", "'edge_shadow'"},
      {head + "[settings]\ngrey_map = [\"linear\", \"soggy\"]\n" + tail, "line 7", "'grey_map' is 'soggy'"},
      {head + "[settings]\ntgc_db = [1, 2]\n" + tail, "line 7", "'tgc_db'"},
      {head + "[settings]\ntgc_shift_db = [1, 200]\n" + tail, "line 7",
       "'tgc_shift_db' goes beyond its limits; write two numbers from"},
      {head + "[settings]\nfrequency_mhz = 4\n" + tail, "line 7", "the frequency belongs to the probe"},
      {head + "[settings]\nimage_width = [64, 128]\n" + tail, "line 7", "all images of a study have the same size"},
      {head + "[settings]\ngian_db = 1\n" + tail, "line 7, column 1",
       "'gian_db' is unknown here; did you mean 'gain_db'?"},
      {head + "[[case]]\ncase = \"nowhere\"\nlicence = \"mine\"\n[[probe]]\nname = \"linear\"\n[[poses]]\nkind = "
              "\"skin\"\n",
       "line 7", "the case 'nowhere' is not there"},
      {head + "[[case]]\ncase = \".\"\n[[probe]]\nname = \"linear\"\n[[poses]]\nkind = \"skin\"\n", "line 6",
       "'licence' is missing"},
      {head + "[[case]]\ncase = \".\"\nlicence = \"mine\"\nphantom = { gallstone = true }\n[[probe]]\nname = "
              "\"linear\"\n[[poses]]\nkind = \"skin\"\n",
       "line 9", "only the built-in patient has options"},
      {head + "[[case]]\nphantom = { gallstone = [true] }\n" + tail, "line 7", "'gallstone' is not a range"},
      {head + "[[case]]\nphantom = { gallstone = { a = 1 } }\n" + tail, "line 7", "'gallstone' is neither true, false"},
      {head + "[[case]]\nname = \"other\"\npatients = 2\nphantom = { gallstone = true }\n" + tail, "line 8",
       "several patients would all be the same one"},
      {head + "[[case]]\nweight = 0\nname = \"other\"\n" + tail, "line 7", "'weight' is 0"},
      {head + "[[case]]\n" + tail, "line 8", "the name 'abdomen' is taken"},
      {head + "[[probe]]\nname = \"linaer\"\n" + tail, "line 7", "did you mean 'linear'?"},
      {head + "[[probe]]\nname = \"linear\"\n" + tail, "line 11", "the name 'linear' is taken"},
      {head + "[[probe]]\nname = \"phased\"\ndepth_mm = [200, 100]\n" + tail, "line 8",
       "'depth_mm' begins with its larger number; write [100, 200]"},
      {head + "[[probe]]\nname = \"phased\"\ndepth_mm = 5\n" + tail, "line 8",
       "'depth_mm' is 5; give a number from 10 to 400"},
      {head + "[[probe]]\nname = \"phased\"\nfrequency_mhz = [3, 31]\n" + tail, "line 8",
       "'frequency_mhz' goes beyond its limits; write two numbers from"},
      {head + "[settings]\ngain_db = [-6, 0, 6]\n" + tail, "line 7",
       "'gain_db' is not a range; write the least and the most in square brackets."},
      {head + tail + "tilt_deg = [-90, 0]\n", "line 12", "'tilt_deg' goes beyond its limits; write two numbers from"},
      {head + tail + "views = [\"hepatorenal\"]\n", "line 12", "the key 'views' is unknown here"},
      {head + tail + "cases = []\n", "line 12", "'cases'"},
      {head + tail + "cases = [\"abdomne\"]\n", "line 12", "the study has no case 'abdomne'; did you mean 'abdomen'?"},
      {head + tail + "probes = [\"phased\"]\n", "line 12", "the study has no probe 'phased'"},
      {head + tail + "[[poses]]\nkind = \"log\"\n", "line 12", "'file' is missing"},
      {head + tail + "[[poses]]\nkind = \"log\"\nfile = \"no.igs.mha\"\n", "line 14, column 8",
       "the log 'no.igs.mha' is not there"},
      {head + "[[case]]\nphantom = { gallstnoe = true }\n" + tail, "line 7, column 25", "'gallstnoe'"},
      {head + "[[case]]\nphantom = { aorta_diameter_mm = [18, 5000] }\n" + tail, "line 7, column 33",
       "'aorta_diameter_mm'"},
      {head + tail + "[[poses]]\nkind = \"foot\"\n", "line 13", "'kind' is 'foot'"},
      {head + "[[probe]]\nname = \"linear\"\n[[poses]]\nkind = \"skin\"\n", "", "the study has no [[case]]"},
      {head + "[[case]]\n[[poses]]\nkind = \"skin\"\n", "", "the study has no [[probe]]"},
      {head + "[[case]]\n[[probe]]\nname = \"linear\"\n", "", "the study has no [[poses]]"},
  };
  for (const auto& bad : cases) {
    const std::string why = why_refused([&] { read(bad.text); });
    INFO(bad.text << " -> " << why);
    CHECK(why.find("study.toml") != std::string::npos);
    CHECK(why.find(bad.place) != std::string::npos);
    CHECK(why.find(bad.problem) != std::string::npos);
  }
}

TEST_CASE("every mistake of a study is reported at once") {
  const std::string why =
      why_refused([] { read("format = 1\nname = \"n\"\nseed = 3\nimages = 0\n[settings]\ngain_db = 99\n"); });
  for (const char* const part : {"'images' is 0", "'gain_db' is 99", "no [[case]]", "no [[probe]]", "no [[poses]]"})
    CHECK(why.find(part) != std::string::npos);
}

TEST_CASE("settings are drawn within their ranges, reach all of them, and follow the patient's seed of the speckle") {
  const Study study = read(std::string(kHead) + R"([settings]
gain_db = [-6, 6]
beam_lines = [5, 9]
samples = [100, 103]
edge_shadow = "either"
grey_map = ["linear", "soft"]
tgc_shift_db = [-2, 3]
)" + kTail);
  const Settings usual = trainer_settings(4, 120);
  std::set<int> beams, samples, maps, shadows;
  double least = 99, most = -99, least_shift = 99, most_shift = -99;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Settings drawn = draw_settings(study, Draws(study.seed, i), 4, 120, 77);
    REQUIRE_FALSE(why_not_valid(drawn));
    CHECK(drawn.speckle_seed == 77);
    CHECK(drawn.image_width == 512);
    CHECK(drawn.focus_mm == usual.focus_mm);
    beams.insert(drawn.beam_lines);
    samples.insert(drawn.samples);
    maps.insert(int(drawn.grey_map));
    shadows.insert(drawn.edge_shadow);
    least = std::min(least, drawn.gain_db);
    most = std::max(most, drawn.gain_db);
    for (std::size_t k = 0; k < 8; ++k) {
      least_shift = std::min(least_shift, drawn.tgc_db[k] - usual.tgc_db[k]);
      most_shift = std::max(most_shift, drawn.tgc_db[k] - usual.tgc_db[k]);
    }
  }
  CHECK(beams == std::set<int>{5, 7, 9});
  CHECK(samples == std::set<int>{100, 101, 102, 103});
  CHECK(maps == std::set<int>{0, 1});
  CHECK(shadows.size() == 2);
  // 2000 draws leave a gap of 1 % at an end with a probability of e^-20.
  CHECK((least >= -6 && least < -5.88));
  CHECK((most <= 6 && most > 5.88));
  CHECK((least_shift >= -2 - 1e-9 && least_shift < -1.95));
  CHECK((most_shift <= 3 + 1e-9 && most_shift > 2.95));
}

TEST_CASE("a key more in a study leaves all other draws as they were") {
  const std::string gain = "[settings]\ngain_db = [-6, 6]\n";
  const Study plain = read(std::string(kHead) + gain + kTail);
  const Study more = read(std::string(kHead) + gain + "dynamic_range_db = [40, 60]\n" + kTail);
  for (std::uint32_t i = 0; i < 20; ++i) {
    Settings a = draw_settings(plain, Draws(3, i), 4, 120, 1), b = draw_settings(more, Draws(3, i), 4, 120, 1);
    CHECK(a.gain_db == b.gain_db);
    CHECK(a.dynamic_range_db != b.dynamic_range_db);
  }
}

TEST_CASE("draws by weight, by steps and below a count are even") {
  std::vector<int> by_weight(3), by_step(4), below(5);
  constexpr int kDraws = 40000;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const Draws draws(9, i);
    ++by_weight[draws.weighted({1, 0, 3}, "w")];
    const double step = draws.step_of({{10, 40.5}, 10}, "s");
    REQUIRE(std::fmod(step, 10) == 0);
    ++by_step.at(std::size_t(step / 10) - 1);
    ++below.at(draws.below(5, "b"));
  }
  // 5 standard deviations of a count of 40000 p (1 - p).
  CHECK(by_weight[0] == Approx(kDraws / 4).margin(5 * 87));
  CHECK(by_weight[1] == 0);
  for (const int count : by_step) CHECK(count == Approx(kDraws / 4).margin(5 * 87));
  for (const int count : below) CHECK(count == Approx(kDraws / 5).margin(5 * 80));
}

TEST_CASE("patients share the shards by weight, and options are drawn for each") {
  const Study study = read(std::string(kHead) + R"([[case]]
name = "healthy"
weight = 1
[[case]]
name = "varied"
weight = 4
patients = 4
phantom = { gallstone = "either", aorta_diameter_mm = [18, 50], voxel_mm = 5 }
[[probe]]
name = "linear"
[[poses]]
kind = "skin"
)");
  const std::vector<StudyPatient> patients = patients_of(study);
  REQUIRE(patients.size() == 5);
  CHECK(patients[0].name == "healthy");
  CHECK(patients[4].name == "varied 4");
  std::set<std::string> diameters;
  for (std::uint32_t shard = 0; shard < 10; ++shard) CHECK(patient_of(patients, shard).number == shard / 2);
  for (std::size_t i = 1; i < 5; ++i) {
    const auto& options = patients[i].options;
    REQUIRE(options.size() == 3);
    diameters.insert(options[1].second);
    CHECK((options[0].second == "true" || options[0].second == "false"));
    CHECK(std::stod(options[1].second) >= 18);
    CHECK(std::stod(options[1].second) <= 50);
    CHECK(options[2].second == "5");
  }
  CHECK(diameters.size() == 4);
  CHECK(patients_of(study)[2].options == patients[2].options);
}

TEST_CASE("the cache keeps every patient of a study") {
  const test::StudyFolder folder;
  setenv("XDG_CACHE_HOME", folder.path.c_str(), 1);
  constexpr std::size_t kPatients = kKeptPhantoms + 2;
  const Study study = read_study(folder.file(
      "study.toml", "format = 1\nname = \"n\"\nseed = 3\nimages = 100\nshard_images = 1\n[[case]]\npatients = " +
                        std::to_string(kPatients) +
                        "\nphantom = { voxel_mm = 10, aorta_diameter_mm = [18, 50] }\n[[probe]]\nname = "
                        "\"linear\"\n[[poses]]\nkind = \"skin\"\n"));
  for (const StudyPatient& patient : patients_of(study)) open_patient(study, patient);
  std::size_t kept = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path / "insonate" / "phantoms"))
    kept += entry.is_directory() && entry.path().filename().string().front() != '.';
  unsetenv("XDG_CACHE_HOME");
  CHECK(kept == kPatients);
}

TEST_CASE("patients without a shard are refused") {
  const auto why = [](const std::string& cases) {
    return why_refused([&] {
      patients_of(read(std::string(kHead) + cases + "[[probe]]\nname = \"linear\"\n[[poses]]\nkind = \"skin\"\n"));
    });
  };
  CHECK(why("[[case]]\npatients = 11\nphantom = { voxel_mm = [2, 3] }\n")
            .find("there are 10 shards for 11 patients; take more images") != std::string::npos);
}
