#pragma once

#include <glm/mat4x4.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"

namespace insonate::python {

namespace py = pybind11;

/// Throws the InputError of array_from(), and drops the error that Python has set.
[[noreturn]] void refuse_array(const char* name);

/// Returns an array that owns the values, without copying them.
template <typename T>
py::array_t<T> array_of(std::vector<T>&& values, const std::vector<py::ssize_t>& shape) {
  auto* const held = new std::vector<T>(std::move(values));
  const py::capsule owner(held, [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
  return py::array_t<T>(shape, held->data(), owner);
}

/// Returns an image as an array of rows by columns.
template <typename T>
py::array_t<T> array_of(Image<T>&& image) {
  const std::vector<py::ssize_t> shape{image.height, image.width};
  return array_of(std::move(image.pixels), shape);
}

/// Returns a read-only array that shares values with an object of Python, and keeps it alive.
template <typename T>
py::array_t<T> shared_array(const std::vector<T>& values, const std::vector<py::ssize_t>& shape, py::handle owner) {
  py::array_t<T> array(shape, values.data(), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Returns the array of real numbers that an object of Python stands for. Throws InputError, which names `name`, if it
/// stands for none.
template <typename Array>
Array array_from(const py::object& given, const char* name) {
  const py::array as_given = py::array::ensure(given);
  const bool is_real = as_given && std::string_view("biuf").find(as_given.dtype().kind()) != std::string_view::npos;
  if (!is_real) refuse_array(name);
  Array numbers = Array::ensure(as_given);
  if (!numbers) refuse_array(name);
  return numbers;
}

/// Returns a 4 x 4 matrix, row by row.
py::array_t<double> array_of(const glm::dmat4& matrix);

/// Reads one pose, a 4 x 4 matrix. Throws InputError for another shape, and for a matrix that is not rigid.
Pose pose_of(const py::object& matrix);
/// Reads poses, an N x 4 x 4 array. Throws InputError in the same way, and names the pose.
std::vector<Pose> poses_of(const py::object& matrices);

}  // namespace insonate::python
