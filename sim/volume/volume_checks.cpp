#include "sim/volume/volume_checks.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>

#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

constexpr double kMinSpacing_mm = 1e-3, kMaxSpacing_mm = 100;
// A probe's face is longer than the least size, and no scanner's table is longer than the most.
constexpr double kMinBody_mm = 20, kMaxBody_mm = 3000;
// Directions are often stored with 6 decimals. As cosines of small angles they lose one or two more digits.
constexpr double kOrthogonalTolerance = 1e-3;

// A CT of 4096 densities stored over all values of 32 bits has a slope of 1e-6; stored in 8 bits, one of 16.
constexpr double kMinSlope = 1e-9, kMaxSlope = 1e4, kMaxIntercept = 1e5;
const char* const kRescaleRemedy = "correct the header, or export the CT again in Hounsfield units";

}  // namespace

void refuse_header(const std::filesystem::path& file, const std::string& problem, const std::string& remedy) {
  throw InputError(file.string(), "header", problem, remedy);
}

void check_size(const std::string& file, std::uint64_t i, std::uint64_t j, std::uint64_t k) {
  const std::string sizes = std::to_string(i) + " x " + std::to_string(j) + " x " + std::to_string(k) + " voxels";
  for (const std::uint64_t side : {i, j, k}) {
    if (side < 2)
      refuse_header(file, "it claims " + sizes + ", which is not a volume", "give a 3D volume of 2 or more slices");
    if (side > kMaxVoxelsPerSide)
      refuse_header(file,
                    "it claims " + sizes + ", above the limit of " + std::to_string(kMaxVoxelsPerSide) + " a side",
                    "check that the file is whole, or crop it");
  }
  if (i * j * k > kMaxVoxels)
    refuse_header(file, "it claims " + sizes + ", above the limit of 2^31 in all", "resample it to fewer voxels");
}

void check_body_size(const std::string& file, const glm::ivec3& voxels, const glm::dvec3& spacing) {
  const glm::dvec3 size = glm::dvec3(voxels) * spacing;
  for (int a = 0; a < 3; ++a)
    if (size[a] < kMinBody_mm || size[a] > kMaxBody_mm)
      refuse_header(file,
                    "the volume measures " + number_text(size.x) + " x " + number_text(size.y) + " x " +
                        number_text(size.z) + " mm, where a body has " + number_text(kMinBody_mm) + " to " +
                        number_text(kMaxBody_mm) + " mm along each axis",
                    "is its spacing in mm, and not in another unit?");
}

void check_rescale(const std::string& file, const std::string& slope_name, double slope,
                   const std::string& intercept_name, double intercept) {
  if (!(slope >= kMinSlope && slope <= kMaxSlope))
    refuse_header(file,
                  "its " + slope_name + " is " + number_text(slope) + ", where a CT has one from " +
                      number_text(kMinSlope) + " to " + number_text(kMaxSlope),
                  kRescaleRemedy);
  if (!(std::abs(intercept) <= kMaxIntercept))
    refuse_header(file,
                  "its " + intercept_name + " is " + number_text(intercept) + ", where a CT has one within +-" +
                      number_text(kMaxIntercept),
                  kRescaleRemedy);
}

void check_positive_spacing(const std::string& file, const glm::dvec3& spacing, const std::string& remedy) {
  for (int a = 0; a < 3; ++a)
    if (!(spacing[a] > 0) || !std::isfinite(spacing[a]))
      refuse_header(file, "the spacing along axis " + std::to_string(a + 1) + " is " + number_text(spacing[a]), remedy);
}

Grid checked_grid(const std::string& file, Grid grid) {
  for (int a = 0; a < 3; ++a) {
    const double spacing = grid.spacing[a];
    if (!(spacing >= kMinSpacing_mm && spacing <= kMaxSpacing_mm))
      refuse_header(file, "the spacing along axis " + std::to_string(a + 1) + " is " + number_text(spacing) + " mm",
                    "give a spacing from 0.001 to 100 mm");
    if (!(std::abs(grid.origin[a]) <= kFurthestOrigin_mm))
      refuse_header(file, "the origin is at " + number_text(grid.origin[a]) + " mm", "correct the origin");
  }
  const glm::dmat3 excess = glm::transpose(grid.direction) * grid.direction - glm::dmat3(1.0);
  double worst = 0;
  bool orthogonal = true;  // also false for NaN
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) {
      worst = std::max(worst, std::abs(excess[c][r]));
      orthogonal &= std::abs(excess[c][r]) <= kOrthogonalTolerance;
    }
  if (!orthogonal) {
    const double determinant = glm::determinant(grid.direction);
    if (std::abs(determinant) < kOrthogonalTolerance)
      refuse_header(file, "the direction matrix is singular", "correct it");
    refuse_header(file, "the axes are not orthogonal: they stretch or shear by " + number_text(worst),
                  "resample it to orthogonal axes");
  }
  // Gram-Schmidt. The third axis keeps its side, because a reflection is legitimate.
  glm::dmat3& d = grid.direction;
  d[0] = glm::normalize(d[0]);
  d[1] = glm::normalize(d[1] - glm::dot(d[1], d[0]) * d[0]);
  const glm::dvec3 third = glm::cross(d[0], d[1]);
  d[2] = glm::dot(third, d[2]) < 0 ? -third : third;
  return grid;
}

}  // namespace insonate
