#include <catch2/catch.hpp>
#include <fcntl.h>
#include <hdf5.h>
#include <nlohmann/json.hpp>
#include <png.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <map>
#include <thread>

#include "sim/core/files.h"
#include "sim/core/image.h"
#include "tests/tools/dataset/study_folder.h"
#include "tools/dataset/shard_file.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// Small pictures of two patients at 5 mm, from views and the skin, with settings that recompile shaders.
const char* const kStudy = R"(
format = 1
name = "small"
seed = 11
images = 22
shard_images = 4
[settings]
image_width = 96
image_height = 80
samples = 128
gain_db = [-6, 6]
edge_shadow = "either"
grey_map = ["linear", "s_curve"]
[[case]]
case = "abdomen"
patients = 2
phantom = { voxel_mm = 5, gallstone = "either", aorta_diameter_mm = [18, 50] }
[[probe]]
name = "curvilinear"
lines = 64
depth_mm = [100, 200]
depth_step_mm = 50
[[probe]]
name = "phased"
lines = 48
depth_mm = 120
[[poses]]
kind = "view"
slide_mm = 5
[[poses]]
kind = "skin"
)";

struct Ran {
  int code;
  std::string out, errors;
};

struct Workplace : test::StudyFolder {
  fs::path study = file("study.toml", kStudy);

  Workplace() { setenv("XDG_CACHE_HOME", (path / "cache").c_str(), 1); }
  ~Workplace() { unsetenv("XDG_CACHE_HOME"); }

  /// @param before  settings of the environment and limits, in front of the program
  Ran run(const std::string& arguments, const std::string& before = "") const {
    const fs::path out = path / "out", errors = path / "errors";
    const std::string line = "cd " + path.string() + " && " + before + " " + INSONATE_DATASET_PROGRAM + " " +
                             arguments + " >" + out.string() + " 2>" + errors.string();
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(errors)};
  }
  std::string make(const std::string& arguments, const std::string& before = "") const {
    const Ran ran = run("make study.toml " + arguments, before);
    INFO(ran.errors);
    REQUIRE(ran.code == 0);
    return ran.out;
  }
  static std::string text_of(const fs::path& file) {
    std::error_code error;
    return fs::file_size(file, error) > 0 && !error ? read_file(file) : "";
  }
};

/// The names and bytes of all files in a folder.
std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
  return files;
}

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

struct Identity {
  ino_t inode;
  timespec written;
  bool operator==(const Identity& other) const {
    return inode == other.inode && written.tv_sec == other.written.tv_sec && written.tv_nsec == other.written.tv_nsec;
  }
};
Identity identity_of(const fs::path& file) {
  struct stat state;
  REQUIRE(stat(file.c_str(), &state) == 0);
  return {state.st_ino, state.st_mtim};
}

}  // namespace

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
  work.make("there --shards 2-5");
  CHECK(work.run("status here").code == 1);
  CHECK(work.run("merge here there").code == 0);
  CHECK(files_of(work.path / "here") == whole);
  CHECK(files_of(work.path / "there").size() == 1);  // its manifest: a shard is moved, not copied

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
  const Ran checked = work.run("check whole");
  CHECK(checked.code == 0);
  CHECK(checked.out.find("6 shards are sound, 0 are damaged, 0 are missing") != std::string::npos);
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

TEST_CASE("a killed run leaves no shard that looks finished, and the next one makes only what is missing") {
  const Workplace work;
  work.make("whole");
  const auto whole = files_of(work.path / "whole");
  int cut = 0;
  for (int round = 0; round < 8; ++round) {
    const std::string name = "killed-" + std::to_string(round);
    const fs::path folder = work.path / name;
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(work.path.c_str()) != 0 || dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO) < 0) _exit(1);
      execl(INSONATE_DATASET_PROGRAM, "insonate-dataset", "make", "study.toml", name.c_str(), nullptr);
      _exit(1);
    }
    // Once some shards are finished and the next is being written, a little later in each round.
    const fs::path seen = folder / "shards" / (round % 2 == 0 ? "00001.h5" : "00003.h5");
    for (int wait = 0; wait < 60000 && !fs::exists(seen); ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(3 * round));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    cut += WIFSIGNALED(status);

    std::map<std::string, Identity> finished;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "shards")) {
      const std::string shard = entry.path().filename().string();
      if (shard.starts_with(".")) continue;
      CHECK(read_file(entry.path()) == whole.at("shards/" + shard));
      finished.emplace(shard, identity_of(entry.path()));
    }
    CHECK(finished.size() >= 2);
    const Ran missing = work.run("status --missing " + name);
    CHECK(missing.code == (finished.size() == 6 ? 0 : 1));
    if (missing.code == 1) work.make(name + " --shards " + missing.out.substr(0, missing.out.find('\n')));
    for (const auto& [shard, before] : finished) CHECK(identity_of(folder / "shards" / shard) == before);
    // Completes the manifest, if the kill came between the last shard and it, and makes nothing.
    CHECK(work.make(name).empty());
    CHECK(files_of(folder) == whole);
  }
  CHECK(cut >= 4);
}

TEST_CASE("what cannot be done ends in one sentence and code 2, and leaves nothing half-written") {
  const Workplace work;
  work.file("wrong.toml", "format = 1\n");
  work.file("other.toml", std::string(kStudy) + "turn_deg = 3\n");
  work.make("set --shards 0");
  const struct {
    std::string arguments, problem;
  } cases[] = {
      {"make nowhere.toml set", "nowhere.toml: there is no such file; check the name"},
      {"make wrong.toml new", "wrong.toml: 6 problems; correct them:"},
      {"make other.toml set", "this folder holds the dataset of another study"},
      {"make study.toml set --shards 6", "--shards: there is no shard 6 of 6"},
      {"make study.toml study.toml/set", "study.toml/set: the folder cannot be made"},
      {"status nowhere", "nowhere/manifest.json: there is no such file"},
      {"merge nowhere set", "nowhere/manifest.json: there is no such file"},
      {"check study.toml", "study.toml/manifest.json: there is no such file"},
  };
  for (const auto& bad : cases) {
    const Ran ran = work.run(bad.arguments);
    INFO(bad.arguments << " -> " << ran.errors);
    CHECK(ran.code == 2);
    CHECK(ran.errors.find(bad.problem) != std::string::npos);
  }
  CHECK_FALSE(fs::exists(work.path / "new"));
  work.file("damaged/manifest.json", "{\"format\": 1}");
  CHECK(work.run("status damaged").errors.find("it is not the manifest of a dataset") != std::string::npos);
  work.file("damaged/manifest.json", "not json");
  CHECK(work.run("status damaged").errors.find("it is not the manifest of a dataset") != std::string::npos);

  const Ran ranks = work.run("make study.toml set", "OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=2");
  CHECK(ranks.code == 2);
  CHECK(ranks.errors.find("the rank '2' of '2' processes does not exist") != std::string::npos);

  // No room for a shard: 16 blocks of 512 or 1024 bytes.
  const Ran full = work.run("make study.toml set --shards 1", "ulimit -f 16;");
  INFO(full.errors);
  CHECK(full.code == 2);
  CHECK(full.errors.find("shards/00001.h5: it cannot be written") != std::string::npos);
  CHECK(files_of(work.path / "set").size() == 2);
}

TEST_CASE("damaged shards and shards of other studies are found") {
  const Workplace work;
  work.make("set");
  const fs::path shard = work.path / "set" / "shards" / "00002.h5";
  const std::string sound = read_file(shard);
  // In the middle lie the images' own bytes, and at the end the texts. The first bytes name the format.
  for (const std::size_t at : {sound.size() / 3, sound.size() / 2, sound.size() - 200, std::size_t(3)}) {
    CAPTURE(at, sound.size());
    std::string bytes = sound;
    for (std::size_t i = 0; i < 64; ++i) bytes[at + i] = char(bytes[at + i] ^ 0x5a);
    write_file(shard, bytes);
    const Ran checked = work.run("check set");
    INFO(checked.out);
    CHECK(checked.code == 1);
    CHECK(checked.out.find("00002.h5") != std::string::npos);
    CHECK(checked.out.find("5 shards are sound, 1 are damaged") != std::string::npos);
  }
  // The same images under another name are not what the manifest lists.
  write_file(shard, read_file(work.path / "set" / "shards" / "00003.h5"));
  CHECK(work.run("check set").out.find("it is not the shard that the manifest lists") != std::string::npos);
  fs::remove(shard);
  CHECK(work.run("status --missing set").out == "2\n");
  work.make("set");
  CHECK((read_file(shard) == sound));  // its bytes would be printed

  work.file("other.toml", std::string(kStudy) + "turn_deg = 3\n");
  REQUIRE(work.run("make other.toml other").code == 0);
  CHECK(work.run("merge set other").errors.find("it holds the dataset of another study") != std::string::npos);
  write_file(shard, read_file(work.path / "other" / "shards" / "00002.h5"));
  CHECK(work.run("check set").out.find("it is a shard of another study") != std::string::npos);
  CHECK(work.run("make study.toml set").errors.find("it is a shard of another study") != std::string::npos);
  write_file(shard, "not HDF5");
  CHECK(work.run("make study.toml set").errors.find("it is not a shard of a dataset") != std::string::npos);
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
