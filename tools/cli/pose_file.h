#pragma once

#include <glm/mat4x4.hpp>

#include <optional>
#include <string>
#include <vector>

#include "sim/core/pose.h"

namespace insonate {

/// Reads a pose file with one or more matrices, row by row. The file is plain text with 16 numbers per pose, or JSON.
/// The JSON is an array, or an object with the array under the name of the matrix. The array holds 16
/// numbers per pose, four rows of four, or several such matrices. Each matrix must be a rotation and a translation in
/// mm (why_not_rigid()). Throws InputError.
/// @param name  of the matrix
std::vector<Pose> read_poses(const std::string& file, const std::string& name = "patient_from_probe");

/// Reads a file with exactly one pose. Throws InputError for any other number.
Pose read_pose(const std::string& file, const std::string& name = "patient_from_probe");

/// Reads the matrix of one image in the same way: it maps (column, row, 0), the centre of a pixel, to mm in the probe's
/// frame, as PLUS's ImageToProbe does. Throws InputError if it is not one matrix, or not one of an image.
glm::dmat4 read_image_matrix(const std::string& file);

/// Returns why a matrix does not place an image, as the problem part of an InputError. Returns nothing if rows and
/// columns are perpendicular, a pixel is from 0.001 mm to 10 mm large, and the origin is within a tracker's range.
std::optional<std::string> why_not_image_matrix(const glm::dmat4& matrix);

}  // namespace insonate
