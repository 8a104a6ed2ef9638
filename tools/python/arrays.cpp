#include "tools/python/arrays.h"

#include "sim/core/input_error.h"

namespace insonate::python {
namespace {

std::string shape_of(const Doubles& array) {
  std::string text;
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i ? " x " : "") + std::to_string(array.shape(i));
  return text.empty() ? "a single number" : text;
}

Pose rigid(const double* rows, const std::string& place) {
  glm::dmat4 matrix(0.0);
  for (int i = 0; i < 16; ++i) matrix[i % 4][i / 4] = rows[i];
  if (const auto why = why_not_rigid(matrix))
    throw InputError("pose", place, *why, "give a rotation and a translation in mm");
  return pose_from_matrix(matrix);
}

}  // namespace

void refuse_array(const char* name) {
  PyErr_Clear();
  throw InputError(name, "", "it is not an array of real numbers", "give a NumPy array, or lists of equal length");
}

py::array_t<double> array_of(const glm::dmat4& matrix) {
  py::array_t<double> array({4, 4});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) array.mutable_at(row, column) = matrix[column][row];
  return array;
}

Pose pose_of(const py::object& given) {
  const auto matrix = array_from<Doubles>(given, "pose");
  if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
    throw InputError("pose", "", "it is an array of " + shape_of(matrix) + ", not of 4 x 4",
                     "give the matrix patient_from_probe");
  return rigid(matrix.data(), "");
}

std::vector<Pose> poses_of(const py::object& given) {
  const auto matrices = array_from<Doubles>(given, "poses");
  if (matrices.ndim() != 3 || matrices.shape(1) != 4 || matrices.shape(2) != 4)
    throw InputError("poses", "", "they are an array of " + shape_of(matrices) + ", not of N x 4 x 4",
                     "give a matrix patient_from_probe for each");
  std::vector<Pose> poses;
  for (py::ssize_t i = 0; i < matrices.shape(0); ++i)
    poses.push_back(rigid(matrices.data(i, 0, 0), "number " + std::to_string(i)));
  return poses;
}

}  // namespace insonate::python
