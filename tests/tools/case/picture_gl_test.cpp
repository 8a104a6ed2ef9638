// insonate-case picture, as a person runs it.

#include <png.h>

#include <cstdlib>

#include "sim/core/image.h"
#include "tests/tools/case/case_workplace.h"

using namespace insonate;

namespace {

Image<Rgba8> read_png(const std::filesystem::path& file) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_file(&header, file.c_str()));
  header.format = PNG_FORMAT_RGBA;
  Image<Rgba8> image(int(header.width), int(header.height));
  REQUIRE(png_image_finish_read(&header, nullptr, image.pixels.data(), 0, nullptr));
  return image;
}

}  // namespace

// The ball has 60 HU and lies in air.
TEST_CASE("a picture shows what the look shows, and the view's plane") {
  Workplace place;
  REQUIRE(place.make(place.made).code == 0);
  const std::string out = (place.folder.path / "picture.png").string();
  const auto draw = [&](const std::string& options) {
    const ProgramOutcome outcome =
        place.run("picture --case " + place.made.string() + " --width 120 --height 90 " + options + " " + out);
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
    return read_png(out);
  };
  const auto bright = [](const Image<Rgba8>& image) {
    return std::count_if(image.pixels.begin(), image.pixels.end(), [](const Rgba8& p) { return p[0] > 60; });
  };
  const Image<Rgba8> skin = draw("--look Skin");
  CHECK(skin.width == 120);
  CHECK(skin.height == 90);
  CHECK(bright(skin) > 1000);
  CHECK(bright(draw("--look Bones")) == 0);
  CHECK(bright(draw("--look Bones --view front")) > 500);
  CHECK(bright(draw("--look Surfaces --from left")) > 500);
  CHECK(bright(draw("--look Bones --structure ball")) > 500);
}

// Pictures of docs/view.md as baselines. The same software renderer draws the same pixels, so that they are equal with
// the Mesa that drew them; another one may round otherwise at edges. A picture without one of its features differs in
// thousands of pixels, as the last check shows. After a wanted change tools/view-pictures draws them anew.
TEST_CASE("the patient looks as in the documents' pictures") {
  const std::filesystem::path root = INSONATE_SOURCE_FOLDER;
  TemporaryFolder drawn;
  const std::vector<std::string> names{"structures", "bones", "plane_in_bones", "plane_in_skin", "surfaces"};
  std::string command = (root / "tools" / "view-pictures").string() + " " +
                        std::filesystem::path(INSONATE_CASE_PROGRAM).parent_path().string() + " " + drawn.path.string();
  for (const std::string& name : names) command += " " + name;
  const ProgramOutcome outcome = run_program(command);
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  const auto different = [](const Image<Rgba8>& a, const Image<Rgba8>& b) {
    REQUIRE(a.pixels.size() == b.pixels.size());
    int count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        if (std::abs(int(a.pixels[i][c]) - int(b.pixels[i][c])) > 8) {
          ++count;
          break;
        }
    return count;
  };
  const auto baseline = [&](const std::string& name) {
    return read_png(root / "docs" / "images" / "view" / (name + ".png"));
  };
  constexpr int kAtEdges = 200;  // of 128,000
  for (const std::string& name : names) {
    INFO(name);
    CHECK(different(read_png(drawn.path / (name + ".png")), baseline(name)) <= kAtEdges);
  }
  CHECK(different(read_png(drawn.path / "structures.png"), baseline("bones")) > 10 * kAtEdges);
}

TEST_CASE("a picture that cannot be drawn is refused") {
  Workplace place;
  REQUIRE(place.make(place.made).code == 0);
  const std::string patient = "picture --case " + place.made.string(), out = (place.folder.path / "p.png").string();
  const auto refused = [&](const std::string& options, const std::string& words) {
    const ProgramOutcome outcome = place.run(patient + " " + options);
    INFO(outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.errors, words));
    CHECK(!std::filesystem::exists(out));
  };
  refused("--look Bons " + out, "did you mean 'Bones'");
  refused("--look none.toml " + out, "none.toml");
  refused("--structure bal " + out, "did you mean 'ball'");
  refused("--look Surfaces --structure ball " + out, "all structures are shown");
  refused("--view frnt " + out, "did you mean 'front'");
  refused((place.folder.path / "p.jpg").string(), "ends in .png");
}
