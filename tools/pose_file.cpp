#include "tools/pose_file.h"

#include <nlohmann/json.hpp>

#include <sstream>

#include "sim/core/files.h"
#include "sim/core/input_error.h"

namespace insonate {

std::vector<Pose> read_poses(const std::string& file) {
  std::string text = read_file(file, 1u << 24);
  std::vector<double> numbers;
  if (const auto json = nlohmann::json::parse(text, nullptr, false); !json.is_discarded()) {
    for (const auto& value : json.is_object() ? json.value("patient_from_probe", nlohmann::json::array()) : json)
      if (value.is_number()) numbers.push_back(value.get<double>());
  } else {
    std::istringstream stream(text);
    for (double number; stream >> number;) numbers.push_back(number);
    if (!stream.eof()) numbers.clear();
  }
  std::vector<Pose> poses;
  if (numbers.size() % 16 != 0) return poses;
  for (std::size_t first = 0; first < numbers.size(); first += 16) {
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i % 4][i / 4] = numbers[first + std::size_t(i)];
    if (const auto why = why_not_rigid(matrix))
      throw InputError(file, "", *why, "give a rotation and a translation in mm");
    poses.push_back(pose_from_matrix(matrix));
  }
  return poses;
}

Pose read_pose(const std::string& file) {
  const std::vector<Pose> poses = read_poses(file);
  if (poses.size() != 1)
    throw InputError(file, "", "there are not 16 numbers",
                     "write the matrix patient_from_probe row by row, as text or JSON");
  return poses.front();
}

}  // namespace insonate
