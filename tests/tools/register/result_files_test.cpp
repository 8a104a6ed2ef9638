// Tests the texts that insonate-register writes, and the start that it fits to landmarks.

#include "tools/register/result_files.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/vec4.hpp>

#include <sstream>
#include <string>

#include "sim/core/input_error.h"
#include "tests/core/run_program.h"
#include "tools/register/start_transform.h"

using namespace insonate;

TEST_CASE("a transform is written as ITK reads it, and never without its verdict") {
  glm::dmat4 matrix = glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(0, 0, 1));
  matrix[3] = glm::dvec4(1.5, -2.25, 3, 1);
  SweepRegistration found;
  found.doubts.emplace_back("another place is nearly as similar");
  const std::string text = itk_transform(matrix, verdict(found));
  CHECK(text.find("#Insight Transform File V1.0\n") == 0);
  CHECK(text.find("# Not converged: another place is nearly as similar. Do not use this transform.\n") !=
        std::string::npos);
  CHECK(text.find("\nTransform: AffineTransform_double_3_3\n") != std::string::npos);
  std::istringstream numbers(text.substr(text.find("Parameters:") + 11));
  double n[12];
  for (double& each : n) numbers >> each;
  // By rows, then the translation.
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) CHECK(n[3 * row + column] == matrix[column][row]);
    CHECK(n[9 + row] == matrix[3][row]);
  }
  CHECK(text.find("\nFixedParameters: 0 0 0\n") != std::string::npos);
}

TEST_CASE("the scene places the sweep behind its transform") {
  const std::string scene = slicer_scene("Converged & \"sure\"");
  CHECK(scene.find("<TransformStorage id=\"vtkMRMLTransformStorageNode1\" fileName=\"sweep_from_ct.tfm\"/>") !=
        std::string::npos);
  CHECK(scene.find("fileName=\"ct.nrrd\"") != std::string::npos);
  const std::size_t sweep = scene.find("name=\"Sweep\"");
  REQUIRE(sweep != std::string::npos);
  CHECK(scene.find("transformNodeRef=\"vtkMRMLLinearTransformNode1\"") > sweep);
  CHECK(scene.find("Converged &amp; &quot;sure&quot;") != std::string::npos);
}

TEST_CASE("landmarks give the start that maps them, and bad ones are refused in a sentence") {
  const TemporaryFolder folder;
  const glm::dmat4 truth =
      glm::translate(glm::dmat4(1.0), glm::dvec3(5, -8, 100)) * glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1, 0, 0));
  std::ostringstream text;
  text.precision(17);
  for (const glm::dvec3& point :
       {glm::dvec3(0, 0, 0), glm::dvec3(40, 0, 5), glm::dvec3(0, 60, 0), glm::dvec3(7, 8, 9)}) {
    const glm::dvec4 in_ct = truth * glm::dvec4(point, 1);
    text << point.x << " " << point.y << " " << point.z << " " << in_ct.x << " " << in_ct.y << " " << in_ct.z << "\n";
  }
  const glm::dmat4 found = start_from_landmarks(folder.put("landmarks.txt", text.str()).string());
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) CHECK(found[column][row] == Approx(truth[column][row]).margin(1e-9));
  const auto refused = [&](const std::string& bad, const std::string& sentence) {
    const std::string file = folder.put("bad.txt", bad).string();
    CHECK_THROWS_WITH(start_from_landmarks(file), Catch::Contains(sentence));
  };
  refused("1 2 3 4 5 6\n1 2 3", "it holds 9 numbers; write six per landmark, of three or more landmarks.");
  refused("1 2 3 4 5 six", "number 6: 'six' is not a number within 100 m of the origin; write six numbers");
  refused("1 2 3 4 5 nan", "number 6: 'nan' is not a number");
  refused("1e300 2 3 4 5 6", "number 1: '1e300' is not a number within 100 m");
  refused("0 0 0 0 0 0 1 1 1 1 1 1 2 2 2 2 2 2", "the landmarks lie on a line");
  refused("0 0 0 0 0 0 50 0 0 1 1 1 0 50 0 2 2 2", "the landmarks lie on a line");
}
