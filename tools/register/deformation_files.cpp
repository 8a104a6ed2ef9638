#include "tools/register/deformation_files.h"

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include <fstream>
#include <limits>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "tools/register/itk_transform.h"

namespace insonate {
namespace {

constexpr int kVoxelsPerSpacing = 8;  // linear between voxels is then within 1/500 of a bend over one spacing

Grid grid_over(const glm::dvec3& low, const glm::dvec3& high, double voxel_mm) {
  Grid grid;
  grid.size = glm::ivec3(glm::ceil((high - low) / voxel_mm)) + 1;
  grid.spacing = glm::dvec3(voxel_mm);
  grid.origin = low;
  return grid;
}

}  // namespace

DeformationGrids deformation_grids(const FreeFormField& field, const glm::dmat4& ct_from_sweep) {
  const double voxel_mm = field.spacing_mm / kVoxelsPerSpacing;
  // The field is 0 from 2 spacings beyond the outermost control points on.
  const glm::dvec3 low = field.origin_mm - 2 * field.spacing_mm,
                   high = field.origin_mm + (glm::dvec3(field.size) + 1.0) * field.spacing_mm;
  glm::dvec3 least(std::numeric_limits<double>::infinity()), most(-least);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z);
    const glm::dvec3 in_ct(ct_from_sweep * glm::dvec4(at, 1));
    least = glm::min(least, in_ct);
    most = glm::max(most, in_ct);
  }
  return {grid_over(low, high, voxel_mm), grid_over(least, most, voxel_mm)};
}

void write_displacements(const std::filesystem::path& nrrd_file, const Grid& grid,
                         const std::function<glm::dvec3(const glm::dvec3&)>& map) {
  const std::vector<double> exact = itk_displacements(grid, map).parameters;
  const std::vector<float> values(exact.begin(), exact.end());
  const auto vector = [](const glm::dvec3& v) {
    return "(" + exact_text(v.x) + "," + exact_text(v.y) + "," + exact_text(v.z) + ")";
  };
  std::string header = "NRRD0004\ntype: float\ndimension: 4\nspace: left-posterior-superior\nsizes: 3";
  for (int axis = 0; axis < 3; ++axis) header += " " + std::to_string(grid.size[axis]);
  header += "\nspace directions: none";
  for (int axis = 0; axis < 3; ++axis) header += " " + vector(grid.spacing[axis] * grid.direction[axis]);
  header +=
      "\nkinds: vector domain domain domain\nendian: little\nencoding: raw\nspace origin: " + vector(grid.origin) +
      "\n\n";
  write_atomically(nrrd_file, [&](const std::filesystem::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    stream << header;
    stream.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof values.front()));
    stream.close();
    if (!stream)
      throw InputError(nrrd_file.string(), "", "it cannot be written", "check the folder's permissions and free space");
  });
}

std::string sentence_about(const FreeFormRegistration& found) {
  const std::string held_out = formatted("LC2 of the images that were not fitted went from %.4f to %.4f (+- %.4f)",
                                         found.held_out_before, found.held_out_after, found.held_out_error);
  if (!found.is_improved())
    return "No deformation: " + held_out + ", which chance explains; the affine map is the result.";
  return "Deformation: " + held_out +
         formatted("; it moves the tissue by up to %.1f mm and does not fold: the least Jacobian is %.2f.",
                   found.most_mm, found.least_jacobian);
}

}  // namespace insonate
