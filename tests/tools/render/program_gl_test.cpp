// Tests insonate-render as its users use it, and the example beside it.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/tools/render/render_scene.h"
#include "tests/tools/render/stage_folder.h"

using namespace insonate;
using namespace insonate::test;
namespace fs = std::filesystem;

namespace {

// Stages have the probe's marker (+x) on the right; pictures for people have it on the left.
std::vector<std::uint8_t> as_shown(const StageFolder& stages) {
  return mirrored(stages.grey()).pixels;
}

/// Returns the mean within 3 mm of a place.
double around(const Volume<std::int16_t>& volume, const glm::dvec3& patient_mm) {
  double sum = 0, count = 0;
  for (int k = 0; k < volume.grid.size.z; ++k)
    for (int j = 0; j < volume.grid.size.y; ++j)
      for (int i = 0; i < volume.grid.size.x; ++i) {
        if (glm::distance(volume.grid.patient_from_index({i, j, k}), patient_mm) > 3) continue;
        sum += volume.at({i, j, k});
        ++count;
      }
  return count > 0 ? sum / count : -1;
}

}  // namespace

TEST_CASE("the picture is what the stages end in, and the command line is above the settings file") {
  const Scene scene;
  const std::string common = "--pose " + scene.in("pose.txt") + " --settings " + scene.in("small.toml");
  for (const std::string by : {"", " --reference"}) {
    const ProgramOutcome outcome =
        scene.render(common + by + " --gain 7 --width 70 --stages " + scene.in("stages") + "/");
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
    const StageFolder stages(scene.in("stages"));
    CHECK(as_shown(stages) == grey_levels(scene.in("image.png")));
    CHECK(stages.image("image").width == 70);
    const auto& settings = stages.description.at("settings");
    CHECK(settings.at("gain_db") == 7);
    CHECK(settings.at("image_height") == 50);
    CHECK(settings.at("samples") == 64);
    CHECK(settings.at("beam_window") == "hann");
    CHECK(settings.at("tgc_db").size() == 8);
    CHECK(settings.at("skipping") == false);  // skipping would leave R without a normal
    CHECK(stages.description.at("labelled_tissues").at("liver").at("echogenicity_db") == 0);
    CHECK((stages.description.at("made_by") == "reference in double precision") == !by.empty());
    fs::remove_all(scene.in("stages"));
  }
}

TEST_CASE("a level of quality takes its share of the settings' samples and pixels") {
  const Scene scene;
  const std::string common = "--pose " + scene.in("pose.txt") + " --settings " + scene.in("small.toml");
  const ProgramOutcome outcome = scene.render(common + " --quality exact --height 40 --stages " + scene.in("stages"));
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  const auto settings = StageFolder(scene.in("stages")).description.at("settings");
  CHECK(settings.at("samples") == 4 * 64);
  CHECK(settings.at("image_height") == 40);
  CHECK(scene.render(common + " --quality best").code == 2);
}

TEST_CASE("model W has its own settings file and picture, alike from the graphics card and from the reference") {
  const Scene scene;
  scene.folder.put("wein.toml", "samples = 80\nimage_width = 60\nimage_height = 50\nreflection_share = 0.3\n");
  const std::string common = "--model W --pose " + scene.in("pose.txt") + " --settings ";
  REQUIRE(scene.render(common + scene.in("wein.toml")).code == 0);
  const std::vector<std::uint8_t> drawn = grey_levels(scene.in("image.png"));
  CHECK(drawn.size() == 60 * 50);
  CHECK(*std::max_element(drawn.begin(), drawn.end()) > 60);
  REQUIRE(scene.render(common + scene.in("wein.toml") + " --reference").code == 0);
  const std::vector<std::uint8_t> reference = grey_levels(scene.in("image.png"));
  REQUIRE(reference.size() == drawn.size());
  int worst = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) worst = std::max(worst, std::abs(drawn[i] - reference[i]));
  CHECK(worst <= 1);  // as in tests/wein/wein_gl_test.cpp

  REQUIRE(scene.render("--model W --pose " + scene.in("pose.txt")).code == 0);
  CHECK(grey_levels(scene.in("image.png")).size() == 128 * 96);
  ProgramOutcome outcome = scene.render(common + scene.in("small.toml"));
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("small.toml: line 4, column 1: the key 'gain_db' is unknown here") != std::string::npos);
  outcome = scene.render("--model W --gain 3");
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("--gain: model W has no such thing; leave it out or take --model S.") != std::string::npos);
}

TEST_CASE("the example of the library renders the picture that insonate-render renders") {
  const Scene scene;
  REQUIRE(scene.render("").code == 0);
  const ProgramOutcome outcome =
      run_program(INSONATE_EXAMPLE_PROGRAM " " + scene.in("ct.nrrd") + " " + scene.in("example.png"));
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  const std::vector<std::uint8_t> grey = grey_levels(scene.in("example.png"));
  CHECK(grey == grey_levels(scene.in("image.png")));
  CHECK(*std::max_element(grey.begin(), grey.end()) > 100);

  CHECK(run_program(INSONATE_EXAMPLE_PROGRAM " " + scene.in("none.nrrd") + " " + scene.in("none.png")).code == 2);
}

TEST_CASE("a sweep becomes a volume in which the patient's parts lie where they are") {
  const Scene scene;
  std::string poses;
  for (int plane = 0; plane < 8; ++plane)
    poses += "1 0 0 0  0 1 0 9  0 0 1 " + std::to_string(3 * plane - 10) + "  0 0 0 1\n";
  scene.folder.put("poses.txt", poses);
  const std::string volume = scene.in("swept.nrrd");
  for (const std::string& how :
       {"--pose " + scene.in("pose.txt") + " --sweep 30 --planes 9", "--freehand " + scene.in("poses.txt")}) {
    const ProgramOutcome outcome = run_program(INSONATE_RENDER_PROGRAM " --ct " + scene.in("ct.nrrd") +
                                               " --probe phased --depth 60 --voxel 1.5 " + how + " " + volume);
    INFO(how << ": " << outcome.errors);
    REQUIRE(outcome.code == 0);
    const Volume<std::int16_t> swept = NrrdFile(volume).volume<std::int16_t>();
    for (const double z : {-3.0, 3.0}) {
      const double cyst = around(swept, {12, 32, z}), tissue = around(swept, {-12, 40, z});
      CHECK(tissue > 60);
      CHECK(cyst < tissue - 30);
      CHECK(cyst >= 0);
    }
    CHECK(around(swept, {0, 3, 0}) == -1);  // in front of the face
    CHECK(around(swept, {45, 20, 0}) == -1);

    // The program's own CT reader accepts it.
    CHECK(run_program(INSONATE_RENDER_PROGRAM " --ct " + volume + " --pose " + scene.in("pose.txt") + " --settings " +
                      scene.in("small.toml") + " " + scene.in("image.png"))
              .code == 0);
  }
  const ProgramOutcome one_plane = run_program(INSONATE_RENDER_PROGRAM " --ct " + scene.in("ct.nrrd") + " --freehand " +
                                               scene.in("pose.txt") + " " + volume);
  CHECK(one_plane.code == 2);
  CHECK(one_plane.errors.find("pose.txt: it holds 1 of the 2 to 2048 poses of a sweep") != std::string::npos);
  std::string and_back;
  for (const double z : {-6.0, 0.0, 6.0, 0.0})
    and_back += "1 0 0 0  0 1 0 9  0 0 1 " + std::to_string(z) + "  0 0 0 1\n";
  scene.folder.put("back.txt", and_back);
  fs::remove(volume);
  const ProgramOutcome turned = run_program(INSONATE_RENDER_PROGRAM " --ct " + scene.in("ct.nrrd") + " --freehand " +
                                            scene.in("back.txt") + " " + volume);
  CHECK(turned.code == 2);
  CHECK(turned.errors.find("back.txt: pose 4: the sweep goes back here") != std::string::npos);
  CHECK(!fs::exists(volume));
  CHECK(scene.render("--sweep 30").errors.find("name a file that ends in .nrrd") != std::string::npos);
}

TEST_CASE("a sweep's volume holds echoes of echoes, and clutter") {
  const Scene scene;
  const std::string volume = scene.in("swept.nrrd");
  const auto swept = [&](const std::string& more) {
    scene.folder.put("sweep.toml", "waves = false\nsamples = 200\nelectronic_noise = false\ngain_db = 15\n" + more);
    const ProgramOutcome outcome =
        run_program(INSONATE_RENDER_PROGRAM " --ct " + scene.in("ct.nrrd") + " --pose " + scene.in("pose.txt") +
                    " --settings " + scene.in("sweep.toml") + " --depth 60 --voxel 2 --sweep 20 --planes 5 " + volume);
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
    return NrrdFile(volume).volume<std::int16_t>().voxels;
  };
  const std::vector<std::int16_t> without = swept("clutter = false\n");
  for (const std::string what :
       {"clutter = false\nreverberation = true\nface_reflection = 1\n", "clutter_db = -10\n"}) {
    const std::vector<std::int16_t> with = swept(what);
    REQUIRE(with.size() == without.size());
    long brighter = 0, darker = 0;
    for (std::size_t i = 0; i < with.size(); ++i) {
      brighter += with[i] > without[i] + 10;
      darker += with[i] < without[i];
    }
    INFO(what);
    CHECK(brighter > 100);
    CHECK(darker == 0);  // added intensities darken nothing
  }
}
