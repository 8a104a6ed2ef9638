#include "tools/register/itk_transform.h"

#include <hdf5.h>
#include <tbb/parallel_for.h>

#include <new>
#include <utility>

#include "sim/core/text.h"

namespace insonate {
namespace {

/// An identifier of the HDF5 library, which is closed at the end.
class Id {
public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw std::bad_alloc();  // nothing else can fail, since the file lies in memory
  }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() { close_(id_); }
  operator hid_t() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void need(herr_t status) {
  if (status < 0) throw std::bad_alloc();
}

// Without the time of its creation, so that the same transform gives the same bytes.
Id timeless(hid_t kind) {
  const hid_t properties = H5Pcreate(kind);
  H5Pset_obj_track_times(properties, false);
  return {properties, H5Pclose};
}

void write_values(hid_t file, const std::string& path, const std::vector<double>& values) {
  const hsize_t size = values.size();
  const Id space(H5Screate_simple(1, &size, nullptr), H5Sclose), how = timeless(H5P_DATASET_CREATE);
  const Id data(H5Dcreate2(file, path.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose);
  need(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

// ITK reads texts of variable length only.
void write_text(hid_t file, const std::string& path, const std::string& text) {
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  need(H5Tset_size(type, H5T_VARIABLE));
  const hsize_t size = 1;
  const Id space(H5Screate_simple(1, &size, nullptr), H5Sclose), how = timeless(H5P_DATASET_CREATE);
  const Id data(H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose);
  const char* of_text = text.c_str();
  need(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &of_text));
}

void write_comment(hid_t file, const std::string& comment) {
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  need(H5Tset_size(type, comment.size() + 1));
  need(H5Tset_cset(type, H5T_CSET_UTF8));
  const Id attribute(H5Acreate2(file, "comment", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  need(H5Awrite(attribute, type, comment.c_str()));
}

void make_group(hid_t file, const char* path) {
  const Id group(H5Gcreate2(file, path, H5P_DEFAULT, timeless(H5P_GROUP_CREATE), H5P_DEFAULT), H5Gclose);
}

// ITK misspells the names of the parameters; later versions also read them as they should be.
void write_parameters(hid_t file, const std::string& kind, const std::vector<double>& values) {
  const std::string misspelt = "/TransformGroup/0/Tranform" + kind, name = "/TransformGroup/0/Transform" + kind;
  write_values(file, misspelt, values);
  need(H5Lcreate_hard(file, misspelt.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
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

std::string as_hdf5(const ItkTransform& transform, const std::string& comment) {
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), how = timeless(H5P_FILE_CREATE);
  need(H5Pset_fapl_core(access, std::size_t(1) << 20, false));  // in memory, which grows by so many bytes
  const Id file(H5Fcreate("transform", H5F_ACC_TRUNC, how, access), H5Fclose);
  write_comment(file, comment);
  make_group(file, "/TransformGroup");
  make_group(file, "/TransformGroup/0");
  write_text(file, "/TransformGroup/0/TransformType", transform.type);
  write_parameters(file, "FixedParameters", transform.fixed_parameters);
  write_parameters(file, "Parameters", transform.parameters);
  need(H5Fflush(file, H5F_SCOPE_LOCAL));
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size < 0) throw std::bad_alloc();
  std::string bytes(std::size_t(size), '\0');
  if (H5Fget_file_image(file, bytes.data(), bytes.size()) < 0) throw std::bad_alloc();
  return bytes;
}

}  // namespace insonate
