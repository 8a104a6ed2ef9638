// Pose files, as text and as JSON.
#include <cstdio>

#include "tests/fuzz/fuzz_target.h"
#include "tools/cli/pose_file.h"

namespace insonate::fuzz {
namespace {

const Target poses_target("poses", [](std::string_view bytes) -> std::string {
  const std::vector<Pose> poses = read_poses(file_with("poses.txt", bytes).string());
  if (poses.empty()) return "a file without poses was taken";
  std::string text;
  for (const Pose& pose : poses) {
    const glm::dmat4 matrix = pose.matrix();
    if (why_not_rigid(matrix)) return "a pose is not rigid";
    for (int i = 0; i < 16; ++i) {
      char number[40];
      std::snprintf(number, sizeof number, "%.17g ", matrix[i % 4][i / 4]);
      text += number;
    }
  }
  return read_poses(file_with("written.txt", text).string()) == poses ? "" : "written and read again they are others";
});

}  // namespace
}  // namespace insonate::fuzz
