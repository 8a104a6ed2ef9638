#include <catch2/catch.hpp>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <thread>

#include "sim/files/files.h"
#include "tests/tools/dataset/dataset_workplace.h"

using namespace insonate;
using namespace insonate::test;
namespace fs = std::filesystem;

namespace {

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
    const ProgramOutcome missing = work.run("status --missing " + name);
    CHECK(missing.code == (finished.size() == 6 ? 0 : 1));
    if (missing.code == 1) work.make(name + " --shards " + missing.output.substr(0, missing.output.find('\n')));
    for (const auto& [shard, before] : finished) CHECK(identity_of(folder / "shards" / shard) == before);
    // Completes the manifest, if the kill came between the last shard and it, and makes nothing.
    CHECK(work.make(name) == "6 shards: there already\n");
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
      {"make study.toml study.toml/set", "study.toml/set: the folder cannot be written"},
      {"status nowhere", "nowhere: it is not the folder of a dataset: manifest.json is missing; begin one"},
      {"merge nowhere set", "nowhere: it is not the folder of a dataset: manifest.json is missing; begin one"},
      {"check study.toml", "study.toml: it is not the folder of a dataset: manifest.json is missing"},
      {"plan study.toml .", ": the folder holds other files, such as '"},
  };
  for (const auto& bad : cases) {
    const ProgramOutcome ran = work.run(bad.arguments);
    INFO(bad.arguments << " -> " << ran.errors);
    CHECK(ran.code == 2);
    CHECK(ran.errors.find(bad.problem) != std::string::npos);
  }
  CHECK_FALSE(fs::exists(work.path / "new"));
  work.file("damaged/manifest.json", "{\"format\": 1}");
  CHECK(work.run("status damaged").errors.find("it is not the manifest of a dataset") != std::string::npos);
  work.file("damaged/manifest.json", "not json");
  CHECK(work.run("status damaged").errors.find("it is not the manifest of a dataset") != std::string::npos);

  // A set that was begun otherwise is not continued.
  const fs::path manifest = work.path / "set" / "manifest.json";
  const std::string begun = read_file(manifest);
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(begun);
  json["program"]["commit"] = "0123456789";
  write_file(manifest, json.dump());
  CHECK(work.run("make study.toml set").errors.find("this dataset was begun by Insonate") != std::string::npos);
  write_file(manifest, begun);
  fs::copy(INSONATE_ASSETS_FOLDER, work.path / "assets", fs::copy_options::recursive);
  write_file(work.path / "assets" / "tissues.toml", read_file(work.path / "assets" / "tissues.toml") + "\n# changed\n");
  CHECK(work.run("make study.toml set", "INSONATE_ASSETS=" + (work.path / "assets").string())
            .errors.find("this dataset was begun with another tissue table") != std::string::npos);

  const ProgramOutcome ranks = work.run("make study.toml set", "OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=2");
  CHECK(ranks.code == 2);
  CHECK(ranks.errors.find("the rank '2' of '2' processes does not exist") != std::string::npos);

  // No room for a shard: 16 blocks of 512 or 1024 bytes.
  const ProgramOutcome full = work.run("make study.toml set --shards 1", "ulimit -f 16;");
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
    const ProgramOutcome checked = work.run("check set");
    INFO(checked.output);
    CHECK(checked.code == 1);
    CHECK(checked.output.find("00002.h5") != std::string::npos);
    CHECK(checked.output.find("5 shards are sound, 1 are damaged") != std::string::npos);
  }
  // The same images under another name are not what the manifest lists.
  write_file(shard, read_file(work.path / "set" / "shards" / "00003.h5"));
  CHECK(work.run("check set").output.find("it is not the shard that the manifest lists") != std::string::npos);
  fs::remove(shard);
  CHECK(work.run("status --missing set").output == "2\n");
  work.make("set");
  CHECK((read_file(shard) == sound));  // its bytes would be printed

  work.file("other.toml", std::string(kStudy) + "turn_deg = 3\n");
  REQUIRE(work.run("make other.toml other").code == 0);
  CHECK(work.run("merge set other").errors.find("it holds the dataset of another study") != std::string::npos);
  write_file(shard, read_file(work.path / "other" / "shards" / "00002.h5"));
  CHECK(work.run("check set").output.find("it is a shard of another study") != std::string::npos);
  CHECK(work.run("make study.toml set").errors.find("it is a shard of another study") != std::string::npos);
  write_file(shard, "not HDF5");
  CHECK(work.run("make study.toml set").errors.find("it is not a shard of a dataset") != std::string::npos);
}
