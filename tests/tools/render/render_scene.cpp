#include "tests/tools/render/render_scene.h"

#include <catch2/catch.hpp>
#include <png.h>

#include <algorithm>

#include "sim/volume/ct_reader.h"
#include "tests/tools/render/synthetic_ct.h"

namespace insonate::test {

namespace fs = std::filesystem;

Scene::Scene() {
  write_ct(folder.path / "ct.nrrd", synthetic_ct());
  folder.put("pose.txt", "1 0 0 0  0 1 0 9  0 0 1 0  0 0 0 1");
  folder.put("small.toml", "samples = 64\nimage_width = 60\nimage_height = 50\ngain_db = 1\n");
}

ProgramOutcome Scene::render(const std::string& more) const {
  return run_program(INSONATE_RENDER_PROGRAM " --ct " + in("ct.nrrd") + " " + more + " " + in("image.png"));
}

std::vector<std::string> Scene::names() const {
  std::vector<std::string> all;
  for (const auto& entry : fs::directory_iterator(folder.path)) all.push_back(entry.path().filename().string());
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<std::uint8_t> grey_levels(const fs::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_file(&png, file.c_str()));
  png.format = PNG_FORMAT_GRAY;
  std::vector<png_byte> bytes(PNG_IMAGE_SIZE(png));
  REQUIRE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr));
  return {bytes.begin(), bytes.end()};
}

}  // namespace insonate::test
