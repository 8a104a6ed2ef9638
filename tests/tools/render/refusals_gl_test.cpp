// Tests what insonate-render refuses, and its error messages.

#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/tools/render/render_scene.h"

using namespace insonate;
using namespace insonate::test;
namespace fs = std::filesystem;

TEST_CASE("what insonate-render cannot do it says in a sentence, and leaves nothing behind") {
  const Scene scene;
  scene.folder.put("long.toml", "samples = 4096\n");
  scene.folder.put("bad.toml", "presett = 'paper'\ngain_db = 99\n");
  fs::create_directory(scene.in("taken"));
  const std::vector<std::string> before = scene.names();

  ProgramOutcome outcome = scene.render("--settings " + scene.in("bad.toml"));
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("bad.toml: 2 problems; correct them:\n"
                            "  line 1, column 1: the key 'presett' is unknown here; did you mean 'preset'?\n"
                            "  line 2, column 11: 'gain_db' is 99; give a number from -60 to 60.") !=
        std::string::npos);

  outcome = scene.render("--stages " + scene.in("taken"));
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("taken: something of this name is there; name a folder that is new.") != std::string::npos);
  CHECK(fs::is_empty(scene.in("taken")));

  outcome = scene.render("--settings " + scene.in("small.toml") + " --stages " + scene.in("ct.nrrd") + "/stages");
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("ct.nrrd/stages: the folder cannot be written") != std::string::npos);

  const auto refused = [&](const std::string& arguments, const std::string& sentence) {
    const ProgramOutcome refusal =
        run_program(INSONATE_RENDER_PROGRAM " --ct " + scene.in("ct.nrrd") + " " + arguments);
    INFO(arguments << ": " << refusal.errors);
    CHECK(refusal.code == 2);
    CHECK(refusal.errors.find(sentence) != std::string::npos);
  };
  const std::string picture = scene.in("image.png"), volume = scene.in("swept.nrrd");
  for (const std::string option : {"--depth", "--gain", "--voxel", "--pivot"})
    refused(option + " nan " + picture, option + ": 'nan' is not a finite number; give one.");
  refused("--sweep nan " + volume, "--sweep: 'nan' is not a finite number");
  refused("--stages '' " + picture, "--stages: nothing is given behind it; give a value or leave it out.");
  refused(scene.in("image.jpg"), "image.jpg: a picture is written as PNG; name a file that ends in .png.");
  // The picture is written before the folder gets its final name, and the folder's parents are removed with it.
  refused("--settings " + scene.in("small.toml") + " --stages " + scene.in("new/stages") + " " +
              scene.in("ct.nrrd/image.png"),
          "ct.nrrd");
  const ProgramOutcome long_lines =
      run_program(INSONATE_RENDER_PROGRAM " --ct " + scene.in("ct.nrrd") + " --settings " + scene.in("long.toml") +
                  " --sweep 20 --planes 2 " + volume);
  if (long_lines.code == 0)
    fs::remove(volume);  // some graphics cards support such textures
  else
    CHECK(long_lines.errors.find("long.toml: a texture of 4096 x 192 x 2 is above") != std::string::npos);
  CHECK((long_lines.code == 0 || long_lines.code == 2));

  CHECK(scene.names() == before);
}

TEST_CASE("insonate-render makes no patient for what it refuses without one") {
  const Scene scene;
  scene.folder.put("bad.toml", "gain_db = 99\n");
  scene.folder.put("bad_pose.txt", "1 2 3\n");
  const auto refused = [&](const std::string& arguments, const std::string& sentence) {
    const ProgramOutcome refusal = run_program("XDG_CACHE_HOME=" + scene.in("cache") + " " INSONATE_RENDER_PROGRAM " " +
                                               arguments + " " + scene.in("image.png"));
    INFO(arguments << ": " << refusal.errors);
    CHECK(refusal.code == 2);
    CHECK(refusal.errors.find(sentence) != std::string::npos);
    CHECK_FALSE(fs::exists(scene.in("cache/insonate")));  // the graphics driver's own cache lies beside it
  };
  refused("--settings " + scene.in("bad.toml"), "'gain_db' is 99");
  refused("--depth 100 --settings " + scene.in("bad.toml"), "'gain_db' is 99");
  refused("--model W --settings " + scene.in("bad.toml"), "the key 'gain_db' is unknown here");
  refused("--pose " + scene.in("bad_pose.txt"), "bad_pose.txt");
}

TEST_CASE("a pose is 16 numbers as text, or JSON of them or of their rows, and faults have their place") {
  const Scene scene;
  const auto outcome_of = [&](const char* name, const std::string& text) {
    scene.folder.put(name, text);
    return scene.render("--settings " + scene.in("small.toml") + " --pose " + scene.in(name));
  };
  REQUIRE(outcome_of("pose.txt", "1 0 0 0\n0 1 0 9\n0 0 1 0\n0 0 0 1\n").code == 0);
  const std::vector<std::uint8_t> picture = grey_levels(scene.in("image.png"));
  for (const char* same : {"[1,0,0,0, 0,1,0,9, 0,0,1,0, 0,0,0,1]", "[[1,0,0,0],[0,1,0,9],[0,0,1,0],[0,0,0,1]]",
                           "{\"patient_from_probe\": [[1,0,0,0],[0,1,0,9],[0,0,1,0],[0,0,0,1]]}",
                           "[[[1,0,0,0],[0,1,0,9],[0,0,1,0],[0,0,0,1]]]"}) {
    fs::remove(scene.in("image.png"));
    const ProgramOutcome outcome = outcome_of("pose.json", same);
    INFO(same << ": " << outcome.errors);
    REQUIRE(outcome.code == 0);
    CHECK(grey_levels(scene.in("image.png")) == picture);
  }

  const auto refused = [&](const std::string& text, const std::string& sentence) {
    const ProgramOutcome outcome = outcome_of("bad", text);
    INFO(text << ": " << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.errors.find("bad: " + sentence) != std::string::npos);
  };
  refused("1 0 0 0\n0 1 0 nan\n0 0 1 0\n0 0 0 1\n",
          "line 2, number 8 of 16: 'nan' is not finite; give a finite number.");
  refused("1 0 0 0\n0 1 0 0\n0 0 1 -inf\n0 0 0 1\n", "line 3, number 12 of 16: '-inf' is not finite");
  refused("1 0 0 0\n0 1 x 0\n", "line 2, number 7 of 16: 'x' is not a number; write the matrix");
  refused("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0", "there are 15 numbers, not 16 for a pose");
  refused("[1,0,0,0, 0,1,0,9, 0,0,1,0, 0,0,0,1, \"x\", null]", "pose 2, number 1 of 16: it is of type string");
  refused("[1,0,0,0, 0,null,0,9, 0,0,1,0, 0,0,0,1]", "number 6 of 16: it is of type null");
  refused("[[1,0,0,0],[0,1,0],[0,0,1,0],[0,0,0,1,0]]", "row 2: it has not 4 numbers");
  refused("[1,0,0,0,\n0,NaN,0,9, 0,0,1,0, 0,0,0,1]", "line 2: this is not JSON with finite numbers");
  refused("[1,0,0,0, 0,1e999,0,9, 0,0,1,0, 0,0,0,1]", "a number is larger than double precision holds");
  refused("{\"pose\": 3}", "there is no key 'patient_from_probe'");
  refused("{\"patient_from_probe\": 3}", "'patient_from_probe' is not an array");
  refused("[[[1,0,0,0],[0,1,0,9],[0,0,1,0],[0,0,0,1]], [1,0]]", "pose 2, matrix: it has not 16 numbers");
}
