#include <catch2/catch.hpp>
#include <hdf5.h>
#include <nlohmann/json.hpp>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "sim/files/files.h"
#include "sim/volume/ct_reader.h"
#include "tests/tools/dataset/dataset_workplace.h"
#include "tools/dataset/shard_file.h"

using namespace insonate;
using namespace insonate::test;
namespace fs = std::filesystem;

namespace {

std::vector<std::uint8_t> map_of(const fs::path& shard, const char* name) {
  const hid_t file = H5Fopen(shard.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(file >= 0);
  const hid_t data = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(data);
  std::vector<std::uint8_t> pixels(std::size_t(H5Sget_simple_extent_npoints(space)));
  REQUIRE(H5Dread(data, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, pixels.data()) >= 0);
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(file);
  return pixels;
}

std::string shard_attribute(const fs::path& shard, const char* name) {
  const hid_t file = H5Fopen(shard.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(file >= 0);
  const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT), type = H5Aget_type(attribute);
  std::string text(H5Tget_size(type), '\0');
  REQUIRE(H5Aread(attribute, type, text.data()) >= 0);
  H5Tclose(type);
  H5Aclose(attribute);
  H5Fclose(file);
  return text.substr(0, text.find('\0'));
}

std::vector<std::uint8_t> png_pixels(const fs::path& file) {
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_file(&image, file.c_str()));
  image.format = PNG_FORMAT_GRAY;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  REQUIRE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));
  return pixels;
}

}  // namespace

TEST_CASE("a CT without labels is said to have none, before any image is made") {
  const Workplace work;
  Volume<std::int16_t> ct{{{60, 60, 40}, glm::dvec3(4), glm::dvec3(-118, -118, -78), glm::dmat3(1)}, {}};
  for (std::size_t i = 0; i < ct.grid.count(); ++i)  // a box of tissue in air
    ct.voxels.push_back(i % 60 > 10 && i % 60 < 50 && i / 60 % 60 > 10 && i / 60 % 60 < 50 ? 40 : -1000);
  write_ct(work.path / "ct.nrrd", ct);
  const auto plan = [&](const std::string& name, const std::string& subject) {
    work.file(name + ".toml", "format = 1\nname = \"n\"\nseed = 3\nimages = 2\nshard_images = 2\n[[case]]\n" + subject +
                                  "[[probe]]\nname = \"linear\"\n[[poses]]\nkind = \"skin\"\n");
    return work.run("plan " + name + ".toml " + name);
  };
  const ProgramOutcome without = plan("bare", "case = \"ct.nrrd\"\nlicence = \"none\"\n");
  INFO(without.errors);
  CHECK(without.code == 0);
  CHECK(without.errors.find("has no labels, so that label and visible_label are 0") != std::string::npos);
  CHECK(plan("built_in", "phantom = { voxel_mm = 4 }\n").errors.find("labels") == std::string::npos);
}

TEST_CASE("one process, ranks, single shards and merged folders give the same bytes") {
  const Workplace work;
  work.make("whole");
  const auto whole = files_of(work.path / "whole");
  REQUIRE(whole.size() == 7);  // six shards and the manifest

  // Two ranks as mpirun starts them, the second one first.
  for (const char* const rank : {"1", "0"})
    work.make("ranks", std::string("OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=") + rank);
  CHECK(files_of(work.path / "ranks") == whole);

  for (const char* const shards : {"5", "0-2,4", "3"}) work.make(std::string("jobs --shards ") + shards);
  CHECK(files_of(work.path / "jobs") == whole);

  work.make("here --shards 0-1");
  work.make("there --shards 1-5");
  CHECK(work.run("status here").code == 1);
  const ProgramOutcome merged = work.run("merge here there");
  CHECK(merged.code == 0);
  CHECK(merged.output.find("there: 4 shards moved, 1 left there, which here has already\n") != std::string::npos);
  CHECK(files_of(work.path / "here") == whole);
  CHECK(files_of(work.path / "there").size() == 2);  // its manifest, and the shard that both have

  // From another disk, shards are copied. /dev/shm is one of its own.
  const fs::path other = fs::path("/dev/shm") / work.path.filename();
  if (fs::exists("/dev/shm")) {
    work.make(other.string() + " --shards 2-4");
    work.make("joined --shards 0-1,5");
    CHECK(work.run("merge joined " + other.string()).code == 0);
    CHECK(files_of(work.path / "joined") == whole);
    CHECK(files_of(other).size() == 1);
    fs::remove_all(other);
  }

  work.make("narrow", "LP_NUM_THREADS=1");
  CHECK(files_of(work.path / "narrow") == whole);
  const ProgramOutcome checked = work.run("check whole");
  CHECK(checked.code == 0);
  CHECK(checked.output.find("6 shards are sound, 0 are damaged, 0 are missing") != std::string::npos);
}

TEST_CASE("any image can be made again alone, to the bit") {
  const Workplace work;
  work.make("set");
  for (const int index : {0, 6, 13, 21}) {
    CAPTURE(index);
    const std::string out = "image-" + std::to_string(index);
    REQUIRE(work.run("image study.toml " + std::to_string(index) + " " + out).code == 0);
    const fs::path shard = work.path / "set" / "shards" / ("0000" + std::to_string(index / 4) + ".h5");
    for (const char* const name : {"image", "label", "visible_label", "reach"}) {
      CAPTURE(name);
      const std::vector<std::uint8_t> all = map_of(shard, name);
      const auto begin = all.begin() + std::ptrdiff_t(index % 4) * 96 * 80;
      CHECK(png_pixels(work.path / out / (std::string(name) + ".png")) ==
            std::vector<std::uint8_t>(begin, begin + 96 * 80));
    }
    const nlohmann::json truth = nlohmann::json::parse(read_file(work.path / out / "truth.json"));
    CHECK(truth.at("index") == index);
    CHECK(truth.at("settings").at("samples") == 128);
    CHECK(truth.at("patient_from_pixel").size() == 4);
    CHECK(truth.at("skin_mm").size() == (truth.at("probe") == "phased" ? 48 : 64));
    CHECK(truth.at("patient") == shard_attribute(shard, "patient"));
    CHECK(truth.at("licence") == shard_attribute(shard, "licence"));
    CHECK(truth.at("labels") == nlohmann::json::parse(shard_attribute(shard, "labels")));
  }
  CHECK(work.run("image study.toml 21 image-21").code == 2);  // the folder is taken
  CHECK(work.run("image study.toml 22 image-22").errors.find("there is no image 22 of 22; count them from 0") !=
        std::string::npos);
}

TEST_CASE("an image does not depend on those before it, even from the same pose") {
  const Workplace work;
  std::string text = kStudy;
  const auto replace = [&](const std::string& from, const std::string& to) {
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
  };
  replace("slide_mm = 5\n", "views = [\"hepatorenal\"]\n");
  replace("[[poses]]\nkind = \"skin\"\n", "");
  replace("depth_mm = [100, 200]", "depth_mm = 160");
  // Skipping leaves out more the less a picture shows.
  replace("gain_db = [-6, 6]", "gain_db = [-60, 60]\ndynamic_range_db = [20, 120]");
  work.file("study.toml", text);
  work.make("set --shards 0-2");
  for (int index = 0; index < 12; ++index) {
    const std::string out = "image-" + std::to_string(index);
    REQUIRE(work.run("image study.toml " + std::to_string(index) + " " + out).code == 0);
    const std::vector<std::uint8_t> all =
        map_of(work.path / "set" / "shards" / ("0000" + std::to_string(index / 4) + ".h5"), "image");
    const auto begin = all.begin() + std::ptrdiff_t(index % 4) * 96 * 80;
    CAPTURE(index);
    CHECK((png_pixels(work.path / out / "image.png") == std::vector<std::uint8_t>(begin, begin + 96 * 80)));
  }
}

TEST_CASE("another device gives the same truth, and the same image within one grey level") {
  const Workplace work;
  work.make("here");
  // Mesa's OpenGL over its software Vulkan: another compiler of shaders, and other arithmetic.
  work.make("there", "GALLIUM_DRIVER=zink XDG_RUNTIME_DIR=/tmp LIBGL_ALWAYS_SOFTWARE=1");
  for (int shard = 0; shard < 6; ++shard) {
    const std::string name = "shards/0000" + std::to_string(shard) + ".h5";
    const fs::path here = work.path / "here" / name, there = work.path / "there" / name;
    for (const char* const map : {"label", "visible_label", "reach"}) CHECK(map_of(here, map) == map_of(there, map));
    const std::vector<std::uint8_t> a = map_of(here, "image"), b = map_of(there, "image");
    int worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(int(a[i]) - int(b[i])));
    CHECK(worst <= 1);
  }
}

TEST_CASE("pictures and labels are of one patient: bone is bright at its front, and dark behind") {
  const Workplace work;
  work.make("set --shards 0-5");
  int with_tissue = 0;
  for (int shard = 0; shard < 6; ++shard) {
    const fs::path file = work.path / "set" / "shards" / ("0000" + std::to_string(shard) + ".h5");
    const auto grey = map_of(file, "image"), label = map_of(file, "label"), reach = map_of(file, "reach");
    double seen = 0, shadowed = 0;
    int seen_pixels = 0, shadowed_pixels = 0;
    for (std::size_t i = 0; i < grey.size(); ++i) {
      if (reach[i] == 0) REQUIRE((grey[i] == 0 && label[i] == 0));
      if (reach[i] == 2) seen += grey[i], ++seen_pixels;
      if (reach[i] == 1) shadowed += grey[i], ++shadowed_pixels;
    }
    REQUIRE(seen_pixels > 1000);
    if (shadowed_pixels < 100) continue;
    ++with_tissue;
    CHECK(seen / seen_pixels > 2 * shadowed / shadowed_pixels);
  }
  CHECK(with_tissue >= 3);
}

TEST_CASE("the manifest names what the set was made from") {
  const Workplace work;
  work.make("set");
  const nlohmann::json json = nlohmann::json::parse(read_file(work.path / "set" / "manifest.json"));
  CHECK(json.at("complete") == true);
  CHECK(json.at("images") == 22);
  CHECK(json.at("study").at("text") == kStudy);
  CHECK(json.at("tissue_table").at("text").get<std::string>().find("[tissue.") != std::string::npos);
  CHECK(json.at("program").at("version").get<std::string>().size() > 3);
  CHECK(json.at("devices").size() == 1);
  REQUIRE(json.at("patients").size() == 2);
  CHECK(json.at("patients")[0].at("licence") == "Apache-2.0, made by Insonate");
  CHECK(json.at("patients")[1].at("options").at("voxel_mm") == "5");
  CHECK(json.at("patients")[0].at("digest") != json.at("patients")[1].at("digest"));
  REQUIRE(json.at("shards").size() == 6);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const fs::path shard = work.path / "set" / json.at("shards")[i].at("file").get<std::string>();
    CHECK(read_shard_summary(shard).digest == json.at("shards")[i].at("digest"));
  }
}
