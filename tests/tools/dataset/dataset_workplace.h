#pragma once

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "sim/files/files.h"
#include "tests/core/run_program.h"
#include "tests/tools/dataset/study_folder.h"

namespace insonate::test {

/// Small pictures of two patients at 5 mm, from views and the skin, with settings that recompile shaders.
inline const char* const kStudy = R"(
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

struct Workplace : StudyFolder {
  std::filesystem::path study = file("study.toml", kStudy);

  Workplace() { setenv("XDG_CACHE_HOME", (path / "cache").c_str(), 1); }
  ~Workplace() { unsetenv("XDG_CACHE_HOME"); }

  /// @param before  settings of the environment and limits, in front of the program
  ProgramOutcome run(const std::string& arguments, const std::string& before = "") const {
    return run_program("cd " + path.string() + " && " + before + " " + INSONATE_DATASET_PROGRAM + " " + arguments);
  }
  std::string make(const std::string& arguments, const std::string& before = "") const {
    const ProgramOutcome ran = run("make study.toml " + arguments, before);
    INFO(ran.errors);
    REQUIRE(ran.code == 0);
    return ran.output;
  }
};

/// The names and bytes of all files in a folder.
inline std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const std::filesystem::directory_entry& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), folder).string()] = read_file(entry.path());
  return files;
}

}  // namespace insonate::test
