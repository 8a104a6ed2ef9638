#pragma once

#include <catch2/catch.hpp>

#include <filesystem>
#include <string>

#include "sim/files/files.h"
#include "tests/core/run_program.h"

/// Runs insonate-score as a person does.
namespace insonate {

inline const std::filesystem::path kAssets = INSONATE_ASSETS_FOLDER;

inline ProgramOutcome run_score(const std::string& arguments) {
  return run_program(INSONATE_SCORE_PROGRAM " " + arguments);
}

/// Returns the bundled exam on a phantom that is made in seconds.
inline std::string coarse_exam() {
  std::string text = read_file(kAssets / "scenarios" / "ruq_hepatorenal.toml");
  const std::string key = "free_fluid = true\n";
  return text.insert(text.find(key) + key.size(), "voxel_mm = 2\n");
}

inline void replace_first(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
}

}  // namespace insonate
