#pragma once

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/core/run_program.h"
#include "tests/core/temporary_folder.h"

namespace insonate {

inline const std::string kBallRecipe = R"(name = "Ball"
grid = { from = [0, 0, 0], to = [24, 20, 20], voxel_mm = 1 }
options.radius_mm = { default = 6, least = 1, most = 9, about = "a radius" }
labels = [{ name = "ball", tissue = "liver", hu = 60 }]
shapes = [{ name = "ball", kind = "ellipsoid", centre = [12, 10, 8], radii = [7, 7, "radius_mm"], label = "ball" }]
landmarks = [{ name = "middle", at = [12, 10, 8] }]
views = [{ name = "front", title = "From the front", probe = "curvilinear", aim = "middle", from = [9, 0, 7], marker = [1, 0, 0], press_mm = 1, landmarks = ["middle"], targets = ["ball"] }]
)";

// A folder with a recipe. Runs the program there and captures what it prints.
struct Workplace {
  TemporaryFolder folder;
  std::filesystem::path recipe = folder.put("ball.toml", kBallRecipe);
  std::filesystem::path made = folder.path / "ball";

  ProgramOutcome run(const std::string& arguments) const {
    return run_program(std::string(INSONATE_CASE_PROGRAM) + " " + arguments);
  }

  ProgramOutcome make(const std::filesystem::path& to, const std::string& more = "") const {
    return run("phantom --recipe " + recipe.string() + " " + more + " " + to.string());
  }

  nlohmann::json inspect(const std::filesystem::path& what) const {
    const ProgramOutcome outcome = run("inspect --json " + what.string());
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
    CHECK(outcome.errors.empty());
    return nlohmann::json::parse(outcome.output);
  }

  // Checks for exit code 2, nothing on standard output, and one sentence that contains each of the words.
  void refused(const std::string& arguments, const std::vector<std::string>& words) const {
    const ProgramOutcome outcome = run(arguments);
    INFO(arguments << "\n" << outcome.output << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.output.empty());
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    for (const std::string& word : words) CHECK(contains(outcome.errors, word));
  }
};

}  // namespace insonate
