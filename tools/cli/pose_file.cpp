#include "tools/cli/pose_file.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "sim/core/input_error.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kNumbers = 16;
/// A file, and the name of the matrices in it.
struct Source {
  std::string file, name;

  std::string wanted() const {
    return "write the matrix " + name + " row by row: 16 numbers as text, or as JSON, there also as 4 rows of 4";
  }
};

/// Returns the text that names the pose of a number, for all but the first pose.
std::string pose_of(std::size_t index) {
  return index < kNumbers ? "" : "pose " + std::to_string(index / kNumbers + 1) + ", ";
}

std::string which(std::size_t index) {
  return pose_of(index) + "number " + std::to_string(index % kNumbers + 1) + " of 16";
}

std::vector<double> numbers_of_text(const Source& source, const std::string& text) {
  std::vector<double> numbers;
  std::istringstream lines(text);
  std::string line, word;
  for (int count = 1; std::getline(lines, line); ++count) {
    std::istringstream words(line);
    while (words >> word) {
      const std::string place = "line " + std::to_string(count) + ", " + which(numbers.size());
      char* end = nullptr;
      numbers.push_back(std::strtod(word.c_str(), &end));
      const bool legible = word.size() <= 40 &&
                           std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isprint(c) != 0; });
      const std::string held = legible ? "'" + word + "'" : "what stands here";
      if (*end) throw InputError(source.file, place, held + " is not a number", source.wanted());
      if (!std::isfinite(numbers.back()))
        throw InputError(source.file, place, held + " is not finite", "give a finite number");
    }
  }
  return numbers;
}

void add_numbers(const Source& source, const Json& array, std::vector<double>& numbers) {
  for (const Json& value : array) {
    if (!value.is_number())
      throw InputError(source.file, which(numbers.size()), std::string("it is of type ") + value.type_name(),
                       source.wanted());
    numbers.push_back(value.get<double>());
  }
}

bool holds_rows(const Json& array) {
  return array.size() == 4 && array[0].is_array() && (array[0].empty() || !array[0][0].is_array()) &&
         array[0].size() != kNumbers;
}

void add_matrix(const Source& source, const Json& array, std::vector<double>& numbers) {
  const std::size_t before = numbers.size();
  const std::string pose = pose_of(before);
  if (array.is_array() && holds_rows(array)) {
    for (std::size_t row = 0; row < 4; ++row) {
      if (!array[row].is_array() || array[row].size() != 4)
        throw InputError(source.file, pose + "row " + std::to_string(row + 1), "it has not 4 numbers", source.wanted());
      add_numbers(source, array[row], numbers);
    }
  } else if (array.is_array()) {
    add_numbers(source, array, numbers);
  }
  if (numbers.size() - before != kNumbers)
    throw InputError(source.file, pose + "matrix", "it has not 16 numbers", source.wanted());
}

Json parsed(const Source& source, const std::string& text) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + std::ptrdiff_t(std::min(error.byte, text.size()));
    throw InputError(source.file, "line " + std::to_string(1 + std::count(text.begin(), end, '\n')),
                     "this is not JSON with finite numbers", source.wanted());
  } catch (const Json::out_of_range&) {
    throw InputError(source.file, "", "a number is larger than double precision holds", "give finite numbers");
  }
}

std::vector<double> numbers_of_json(const Source& source, const std::string& text) {
  const Json json = parsed(source, text);
  if (json.is_object() && !json.contains(source.name))
    throw InputError(source.file, "", "there is no key '" + source.name + "'", source.wanted());
  const Json& array = json.is_object() ? json.at(source.name) : json;
  if (!array.is_array()) throw InputError(source.file, "", "'" + source.name + "' is not an array", source.wanted());
  std::vector<double> numbers;
  if (array.empty() || !array[0].is_array())
    add_numbers(source, array, numbers);
  else if (holds_rows(array))
    add_matrix(source, array, numbers);
  else
    for (const Json& matrix : array) add_matrix(source, matrix, numbers);
  return numbers;
}

std::vector<glm::dmat4> read_matrices(const Source& source) {
  const std::string text = read_file(source.file, 1u << 24);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool is_json = first != std::string::npos && (text[first] == '[' || text[first] == '{');
  const std::vector<double> numbers = is_json ? numbers_of_json(source, text) : numbers_of_text(source, text);
  if (numbers.empty() || numbers.size() % kNumbers != 0)
    throw InputError(source.file, "", "there are " + std::to_string(numbers.size()) + " numbers, not 16 for a pose",
                     source.wanted());
  std::vector<glm::dmat4> matrices(numbers.size() / kNumbers);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    matrices[i / kNumbers][int(i % 4)][int(i % kNumbers / 4)] = numbers[i];
  return matrices;
}

}  // namespace

std::vector<Pose> read_poses(const std::string& file, const std::string& name) {
  const std::vector<glm::dmat4> matrices = read_matrices({file, name});
  std::vector<Pose> poses;
  for (const glm::dmat4& matrix : matrices) {
    if (const auto why = why_not_rigid(matrix))
      throw InputError(file, matrices.size() > 1 ? "pose " + std::to_string(poses.size() + 1) : "", *why,
                       "give a rotation and a translation in mm");
    poses.push_back(pose_from_matrix(matrix));
  }
  return poses;
}

Pose read_pose(const std::string& file, const std::string& name) {
  const std::vector<Pose> poses = read_poses(file, name);
  if (poses.size() != 1)
    throw InputError(file, "", "there are " + std::to_string(poses.size()) + " poses, not one", "keep one of them");
  return poses.front();
}

std::optional<std::string> why_not_image_matrix(const glm::dmat4& matrix) {
  constexpr double kMaxShear = 0.01, kMinPixel_mm = 1e-3, kMaxPixel_mm = 10;
  const glm::dvec3 column(matrix[0]), row(matrix[1]), origin(matrix[3]);
  for (const glm::dvec3& step : {column, row})
    if (!(glm::length(step) >= kMinPixel_mm && glm::length(step) <= kMaxPixel_mm))
      return "a pixel is not from 0.001 mm to 10 mm large";
  if (!(std::abs(glm::dot(column, row)) <= kMaxShear * glm::length(column) * glm::length(row)))
    return "the image's rows and columns are not perpendicular";
  if (!(glm::length(origin) <= kTrackerRange_mm) || glm::transpose(matrix)[3] != glm::dvec4(0, 0, 0, 1))
    return "the last row is not 0 0 0 1, or the translation is too large";
  return std::nullopt;
}

glm::dmat4 read_image_matrix(const std::string& file) {
  const std::vector<glm::dmat4> matrices = read_matrices({file, "ImageToProbe"});
  const char* const remedy = "give the matrix ImageToProbe of the probe's calibration, in mm per pixel";
  if (matrices.size() != 1)
    throw InputError(file, "", "there are " + std::to_string(matrices.size()) + " matrices, not one", remedy);
  if (const auto why = why_not_image_matrix(matrices.front())) throw InputError(file, "", *why, remedy);
  return matrices.front();
}

}  // namespace insonate
