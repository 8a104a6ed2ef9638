// Pose files that cannot be used: the sentence names the place and what to write.
#include "tools/cli/pose_file.h"

#include <catch2/catch.hpp>

#include "tests/core/temporary_folder.h"

using namespace insonate;

namespace {

const std::string kRows = "[[1,0,0,0],[0,1,0,9],[0,0,1,0],[0,0,0,1]]";

}  // namespace

TEST_CASE("a pose file that cannot be used is refused with the place of what is wrong") {
  const TemporaryFolder folder;
  const struct {
    std::string text, says;
  } bad[] = {
      {"1 0 0 0\n0 1 x 0\n", "line 2, number 7 of 16: 'x' is not a number; write the matrix patient_from_probe"},
      {"1 0 0 0\n0 1 0 \x01\n", "line 2, number 8 of 16: what stands here is not a number"},
      {"1 0 0 0\n0 1 0 nan\n0 0 1 0\n0 0 0 1\n", "line 2, number 8 of 16: 'nan' is not finite; give a finite number"},
      {"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0", "there are 15 numbers, not 16 for a pose"},
      {"2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "give a rotation and a translation in mm"},
      {"[1,0,0,0, 0,null,0,9, 0,0,1,0, 0,0,0,1]", "number 6 of 16: it is of type null"},
      {"[1,0,0,0, 0,1,0,9, 0,0,1,0, 0,0,0,1, \"x\"]", "pose 2, number 1 of 16: it is of type string"},
      {"[[1,0,0,0],[0,1,0],[0,0,1,0],[0,0,0,1,0]]", "row 2: it has not 4 numbers"},
      {"[" + kRows + ", [1,0]]", "pose 2, matrix: it has not 16 numbers"},
      {"[1,0,0,0,\n0,NaN,0,9, 0,0,1,0, 0,0,0,1]", "line 2: this is not JSON with finite numbers"},
      {"[1,0,0,0, 0,1e999,0,9, 0,0,1,0, 0,0,0,1]", "a number is larger than double precision holds"},
      {"{\"pose\": 3}", "there is no key 'patient_from_probe'"},
      {"{\"patient_from_probe\": 3}", "'patient_from_probe' is not an array"},
  };
  for (const auto& [text, says] : bad) {
    const std::string file = folder.put("held.txt", text).string();
    INFO(text);
    CHECK_THROWS_WITH(read_poses(file), Catch::StartsWith(file + ": ") && Catch::Contains(says));
  }
  CHECK_THROWS_WITH(read_pose(folder.put("two.json", "[" + kRows + "," + kRows + "]").string()),
                    Catch::Contains("two.json: there are 2 poses, not one; keep one of them"));
  CHECK(read_pose(folder.put("one.json", kRows).string()).translation.y == 9);
}

TEST_CASE("the matrix of an image is read by rows") {
  const TemporaryFolder folder;
  const std::string file = folder.put("image.txt", "0 0.2 0 11\n-0.2 0 0 50\n0 0 0.2 3\n0 0 0 1\n").string();
  const glm::dmat4 matrix = read_image_matrix(file);
  CHECK(matrix[0] == glm::dvec4(0, -0.2, 0, 0));
  CHECK(matrix[1] == glm::dvec4(0.2, 0, 0, 0));
  CHECK(matrix[3] == glm::dvec4(11, 50, 3, 1));
}

TEST_CASE("a matrix that places no image is refused") {
  const TemporaryFolder folder;
  const struct {
    std::string text, says;
  } bad[] = {
      {"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "there are 2 matrices, not one"},
      {"0 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "a pixel is not from 0.001 mm to 10 mm large"},
      {"1 0 0 0 0 11 0 0 0 0 1 0 0 0 0 1", "a pixel is not from 0.001 mm to 10 mm large"},
      {"1 0.02 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "the image's rows and columns are not perpendicular"},
      {"1 0 0 1e300 0 1 0 0 0 0 1 0 0 0 0 1", "the last row is not 0 0 0 1, or the translation is too large"},
      {"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1", "the last row is not 0 0 0 1, or the translation is too large"},
  };
  for (const auto& [text, says] : bad) {
    INFO(text);
    CHECK_THROWS_WITH(read_image_matrix(folder.put("image.txt", text).string()),
                      Catch::Contains("image.txt: " + std::string(says) + "; give the matrix ImageToProbe"));
  }
}
