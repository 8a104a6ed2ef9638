#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/trainer/trainer.h"
#include "devices/sequence/sequence.h"
#include "sim/files/files.h"
#include "sim/volume/case.h"
#include "tests/core/temporary_folder.h"
#include "tests/scenarios/tiny_case.h"

namespace insonate {

/// A temporary folder for one test, with the tiny case, its exam, and a scan that shows the ball.
struct TrainerFolder : TemporaryFolder {
  TrainerFolder() {
    // Keeps the user's own results and settings out of the test.
    setenv("XDG_DATA_HOME", (path / "data").c_str(), 1);
    setenv("XDG_CONFIG_HOME", (path / "config").c_str(), 1);
    write_case(path / "tiny", tiny_case());
    write_file(path / "exam.toml", kTinyScenario);
    write_file(path / "scan.igs.mha", write_sequence(samples_of(4, 60, [](double t) {
                 return Pose{glm::dmat3(1.0), {0, 1, std::max(2.0, 20 - 20 * t)}};
               })));
  }

  Options options() const {
    Options options;
    options.case_folder = path / "tiny";
    options.scenario = path / "exam.toml";
    options.tracker = "replay:" + (path / "scan.igs.mha").string();
    options.out = path / "out";
    return options;
  }
  std::filesystem::path file(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << bytes;
    return path / name;
  }
};

inline constexpr PictureSizes kSizes{320, 240, 160, 120};

inline void open_and_wait(Trainer& trainer, const std::filesystem::path& path) {
  trainer.open(path);
  trainer.finish_loading();
}

}  // namespace insonate
