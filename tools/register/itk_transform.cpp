#include "tools/register/itk_transform.h"

#include <tbb/parallel_for.h>

#include <stdexcept>

#include "sim/core/text.h"
#include "tools/cli/hdf5_id.h"

namespace insonate {
namespace {

void need(bool done) {
  if (!done) throw std::runtime_error("the HDF5 library cannot write a transform");
}

void write_values(hid_t file, const std::string& path, const std::vector<double>& values) {
  const hsize_t size = values.size();
  const Hdf5Id space(H5Screate_simple(1, &size, nullptr), H5Sclose), how = hdf5_without_time(H5P_DATASET_CREATE);
  const Hdf5Id data(H5Dcreate2(file, path.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose);
  need(data >= 0 && H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
}

// ITK reads texts of variable length only.
void write_text(hid_t file, const std::string& path, const std::string& text) {
  const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  need(H5Tset_size(type, H5T_VARIABLE) >= 0);
  const hsize_t size = 1;
  const Hdf5Id space(H5Screate_simple(1, &size, nullptr), H5Sclose), how = hdf5_without_time(H5P_DATASET_CREATE);
  const Hdf5Id data(H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose);
  const char* of_text = text.c_str();
  need(data >= 0 && H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &of_text) >= 0);
}

void make_group(hid_t file, const std::string& path) {
  const Hdf5Id how = hdf5_without_time(H5P_GROUP_CREATE);
  need(Hdf5Id(H5Gcreate2(file, path.c_str(), H5P_DEFAULT, how, H5P_DEFAULT), H5Gclose) >= 0);
}

// ITK misspells the names of the parameters; later versions read the right spelling too.
void write_parameters(hid_t file, const std::string& group, const std::string& kind,
                      const std::vector<double>& values) {
  const std::string misspelt = group + "/Tranform" + kind, name = group + "/Transform" + kind;
  write_values(file, misspelt, values);
  need(H5Lcreate_hard(file, misspelt.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0);
}

}  // namespace

ItkTransform itk_affine(const glm::dmat4& map) {
  ItkTransform transform{"AffineTransform_double_3_3", {0, 0, 0}, {}};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) transform.parameters.push_back(map[column][row]);
  for (int row = 0; row < 3; ++row) transform.parameters.push_back(map[3][row]);
  return transform;
}

ItkTransform itk_displacements(const Grid& grid, const std::function<glm::dvec3(const glm::dvec3&)>& map) {
  ItkTransform transform{"DisplacementFieldTransform_double_3_3", {}, {}};
  for (int axis = 0; axis < 3; ++axis) transform.fixed_parameters.push_back(grid.size[axis]);
  for (int axis = 0; axis < 3; ++axis) transform.fixed_parameters.push_back(grid.origin[axis]);
  for (int axis = 0; axis < 3; ++axis) transform.fixed_parameters.push_back(grid.spacing[axis]);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) transform.fixed_parameters.push_back(grid.direction[column][row]);
  transform.parameters.resize(3 * grid.count());
  tbb::parallel_for(0, grid.size.z, [&](int k) {
    double* moved = transform.parameters.data() + 3 * grid.offset({0, 0, k});
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        const glm::dvec3 p = grid.patient_from_index({i, j, k}), by = map(p) - p;
        for (int axis = 0; axis < 3; ++axis) *moved++ = by[axis];
      }
  });
  return transform;
}

std::string as_tfm(const ItkTransform& transform, const std::string& comment) {
  std::string text = "#Insight Transform File V1.0\n# " + comment + "\n#Transform 0\nTransform: " + transform.type;
  text += "\nParameters:";
  for (const double value : transform.parameters) text += " " + exact_text(value);
  text += "\nFixedParameters:";
  for (const double value : transform.fixed_parameters) text += " " + exact_text(value);
  return text + "\n";
}

std::string as_hdf5(const std::vector<ItkTransform>& applied_last_to_first, const std::string& comment) {
  use_hdf5();
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), how = hdf5_without_time(H5P_FILE_CREATE);
  need(H5Pset_fapl_core(access, std::size_t(1) << 20, false) >= 0);  // in memory, which grows by so many bytes
  const Hdf5Id file(H5Fcreate("a transform in memory", H5F_ACC_TRUNC, how, access), H5Fclose);
  need(file >= 0 && write_hdf5_attribute(file, "comment", comment));
  int written = 0;
  const auto next_group = [&](const std::string& type) {
    std::string group = "/TransformGroup/" + std::to_string(written++);
    make_group(file, group);
    write_text(file, group + "/TransformType", type);
    return group;
  };
  make_group(file, "/TransformGroup");
  if (applied_last_to_first.size() > 1) next_group("CompositeTransform_double_3_3");
  for (const ItkTransform& transform : applied_last_to_first) {
    const std::string group = next_group(transform.type);
    write_parameters(file, group, "FixedParameters", transform.fixed_parameters);
    write_parameters(file, group, "Parameters", transform.parameters);
  }
  need(H5Fflush(file, H5F_SCOPE_LOCAL) >= 0);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  need(size > 0);
  std::string bytes(std::size_t(size), '\0');
  need(H5Fget_file_image(file, bytes.data(), bytes.size()) >= 0);
  return bytes;
}

}  // namespace insonate
