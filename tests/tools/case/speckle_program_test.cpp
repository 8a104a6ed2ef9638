// insonate-case speckle, as a person runs it.

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "sim/files/files.h"
#include "tests/tools/case/case_workplace.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// A case, and a volume of few voxels of it: a second's work.
struct Scattered {
  Workplace place;
  std::string small;

  Scattered() {
    REQUIRE(place.make(place.made).code == 0);
    std::string text = read_file(place.made / "case.toml");
    const std::size_t depth = text.find("depth_mm");
    text.replace(depth, text.find('\n', depth) - depth, "depth_mm = 20");
    place.folder.put("ball/case.toml", text);
    small = "speckle --case " + place.made.string() + " --voxel 0.5 --thickness 2 ";
  }
  fs::path file(const char* name) const { return place.folder.path / name; }
  std::string bytes(const char* name) const { return read_file(file(name)); }
  bool has_strips() const {
    for (const auto& entry : fs::directory_iterator(place.folder.path))
      if (entry.path().string().find(".strips-") != std::string::npos) return true;
    return false;
  }
};

}  // namespace

TEST_CASE("insonate-case speckle: killed and started again it writes the bytes of a run that was not, and says so") {
  const Scattered at;
  const ProgramOutcome whole = at.place.run(at.small + at.file("whole.nrrd").string());
  INFO(whole.errors);
  REQUIRE(whole.code == 0);
  CHECK(contains(whole.output, "voxels"));
  CHECK(contains(whole.errors, "s left"));
  CHECK_FALSE(at.has_strips());

  // A strip that is there is taken as it is; one that a kill has cut off never has the name of a strip. On a busy
  // machine the program may be through before it is killed: then once more.
  const std::string program = std::string(INSONATE_CASE_PROGRAM) + " " + at.small + at.file("killed.nrrd").string();
  for (int attempt = 0; attempt < 20 && !at.has_strips(); ++attempt) {
    fs::remove(at.file("killed.nrrd"));
    run_program(
        "sh -c '" + program + " & while kill -0 $! 2>/dev/null && [ $(ls -d " + at.place.folder.path.string() +
        "/*.strips-*/strip-* 2>/dev/null | wc -l) = 0 ]; do sleep 0.01; done; kill -KILL $! 2>/dev/null; wait'");
  }
  CHECK_FALSE(fs::exists(at.file("killed.nrrd")));
  CHECK(at.has_strips());
  REQUIRE(run_program(program).code == 0);
  CHECK(at.bytes("killed.nrrd") == at.bytes("whole.nrrd"));
  CHECK_FALSE(at.has_strips());
  CHECK(contains(run_program(program).output, "is there already"));

  // Two at once share their work; a third makes another volume of the same name's folder.
  std::string other;
  {
    std::thread one([&] { at.place.run(at.small + at.file("shared.nrrd").string()); }),
        two([&] { at.place.run(at.small + at.file("shared.nrrd").string()); }),
        three([&] { at.place.run(at.small + "--seed 2 " + at.file("other.nrrd").string()); });
    one.join(), two.join(), three.join();
  }
  CHECK(at.bytes("shared.nrrd") == at.bytes("whole.nrrd"));
  CHECK(at.bytes("other.nrrd") != at.bytes("whole.nrrd"));
  CHECK_FALSE(at.has_strips());
}

TEST_CASE("insonate-case speckle: what cannot be used is refused in a sentence") {
  const Scattered at;
  at.place.refused(at.small + at.file("speckle.png").string(), {"speckle.png", "NRRD"});
  at.place.refused(at.small + "--view side " + at.file("x.nrrd").string(), {"--view", "'side'"});
  at.place.refused(at.small + "--transducer " + at.file("missing.toml").string() + " " + at.file("x.nrrd").string(),
                   {"missing.toml", "no such file"});
  CHECK_FALSE(at.has_strips());
  // A full disk, which a file that may not grow stands for: the first strip does not fit.
  const ProgramOutcome full = run_program("sh -c 'ulimit -f 1; trap \"\" XFSZ; " + std::string(INSONATE_CASE_PROGRAM) +
                                          " " + at.small + at.file("full.nrrd").string() + "'");
  INFO(full.errors);
  CHECK(full.code == 2);
  CHECK(contains(full.errors, "cannot be written"));
  CHECK_FALSE(fs::exists(at.file("full.nrrd")));
}
