// insonate-render as its users meet it, and the example beside it.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <png.h>

#include <algorithm>
#include <utility>

#include "tests/tools/render/render_program.h"
#include "tests/tools/render/stage_folder.h"

using namespace outsider;
namespace fs = std::filesystem;

namespace {

struct Scene {
  TestFolder folder;
  Scene() {
    SyntheticCt().write_nrrd(folder.path / "ct.nrrd");
    folder.file("pose.txt", "1 0 0 0  0 1 0 9  0 0 1 0  0 0 0 1");
    folder.file("small.toml", "samples = 64\nimage_width = 60\nimage_height = 50\ngain_db = 1\n");
  }
  std::string in(const char* name) const { return (folder.path / name).string(); }
  Outcome render(const std::string& more) const {
    return run(folder, INSONATE_RENDER_PROGRAM, "--ct " + in("ct.nrrd") + " " + more + " " + in("image.png"));
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder.path)) all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }
};

std::vector<double> grey_levels(const fs::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_file(&png, file.c_str()));
  png.format = PNG_FORMAT_GRAY;
  std::vector<png_byte> bytes(PNG_IMAGE_SIZE(png));
  REQUIRE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr));
  return {bytes.begin(), bytes.end()};
}

// Stages have the probe's marker (+x) on the right, pictures for people on the left.
std::vector<double> as_shown(Plane plane) {
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width / 2; ++x) std::swap(plane.at(x, y), plane.at(plane.width - 1 - x, y));
  return plane.values;
}

}  // namespace

TEST_CASE("the picture is what the stages end in, and the command line is above the settings file") {
  const Scene scene;
  const std::string common = "--pose " + scene.in("pose.txt") + " --settings " + scene.in("small.toml");
  for (const std::string by : {"", " --reference"}) {
    const Outcome outcome = scene.render(common + by + " --gain 7 --width 70 --stages " + scene.in("stages") + "/");
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
    const StageFolder stages = read_stage_folder(scene.in("stages"));
    CHECK(as_shown(stages.planes.at("image")) == grey_levels(scene.in("image.png")));
    CHECK(stages.planes.at("image").width == 70);
    const auto& settings = stages.description.at("settings");
    CHECK(settings.at("gain_db") == 7);
    CHECK(settings.at("image_height") == 50);
    CHECK(settings.at("samples") == 64);
    CHECK(settings.at("beam_window") == "hann");
    CHECK(settings.at("tgc_db").size() == 8);
    CHECK((stages.description.at("made_by") == "reference in double precision") == !by.empty());
    fs::remove_all(scene.in("stages"));
  }
}

TEST_CASE("what insonate-render cannot do it says in a sentence, and leaves nothing behind") {
  const Scene scene;
  scene.folder.file("bad.toml", "presett = 'paper'\ngain_db = 99\n");
  fs::create_directory(scene.in("taken"));
  const std::vector<std::string> before = scene.names();

  Outcome outcome = scene.render("--settings " + scene.in("bad.toml"));
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("bad.toml: line 1, column 11: the key 'presett' is unknown here; did you mean 'preset'?") !=
        std::string::npos);
  CHECK(outcome.errors.find("bad.toml: line 2, column 11: 'gain_db' is 99; give a number from -60 to 60.") !=
        std::string::npos);

  outcome = scene.render("--stages " + scene.in("taken"));
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("taken: something of this name is there; name a folder that is new.") != std::string::npos);
  CHECK(fs::is_empty(scene.in("taken")));

  outcome = scene.render("--settings " + scene.in("small.toml") + " --stages " + scene.in("ct.nrrd") + "/stages");
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("ct.nrrd/stages: the folder cannot be written") != std::string::npos);

  std::vector<std::string> after = scene.names();
  after.erase(std::remove(after.begin(), after.end(), "errors"), after.end());
  CHECK(after == before);
}

TEST_CASE("the example of the library renders the picture that insonate-render renders") {
  const Scene scene;
  REQUIRE(scene.render("").code == 0);
  const Outcome outcome =
      run(scene.folder, INSONATE_EXAMPLE_PROGRAM, scene.in("ct.nrrd") + " " + scene.in("example.png"));
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  const std::vector<double> grey = grey_levels(scene.in("example.png"));
  CHECK(grey == grey_levels(scene.in("image.png")));
  CHECK(*std::max_element(grey.begin(), grey.end()) > 100);

  CHECK(run(scene.folder, INSONATE_EXAMPLE_PROGRAM, scene.in("none.nrrd") + " " + scene.in("none.png")).code == 2);
}
