// Tests the texts that insonate-register writes, and the start that it fits to landmarks.

#include "tools/register/result_files.h"

#include <catch2/catch.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "sim/core/input_error.h"
#include "tests/core/run_program.h"
#include "tools/cli/hdf5_id.h"
#include "tools/register/comparison_pictures.h"
#include "tools/register/deformation_files.h"
#include "tools/register/itk_transform.h"
#include "tools/register/start_transform.h"

using namespace insonate;

TEST_CASE("a transform is written as ITK reads it, and never without its verdict") {
  glm::dmat4 matrix = glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(0, 0, 1));
  matrix[3] = glm::dvec4(1.5, -2.25, 3, 1);
  SweepRegistration found;
  found.doubts.emplace_back("another place is nearly as similar");
  const std::string text = as_tfm(itk_affine(matrix), verdict(found));
  CHECK(text.find("#Insight Transform File V1.0\n") == 0);
  CHECK(text.find("# Not converged: another place is nearly as similar. Do not use this transform. A nearer "
                  "start may help, or a longer sweep.\n") != std::string::npos);
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

namespace {

// Reads the transforms of a file as ITK's HDF5TransformIO does, which takes one spelling of the parameters' names or
// the other.
std::vector<ItkTransform> read_as_itk(const std::filesystem::path& path, const std::string& spelling) {
  const Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Hdf5Id all(H5Gopen2(file, "/TransformGroup", H5P_DEFAULT), H5Gclose);
  H5G_info_t groups{};
  REQUIRE(H5Gget_info(all, &groups) >= 0);
  std::vector<ItkTransform> read;
  for (hsize_t i = 0; i < groups.nlinks; ++i) {
    const Hdf5Id group(H5Gopen2(all, std::to_string(i).c_str(), H5P_DEFAULT), H5Gclose);
    const auto values = [&](const std::string& name) {
      const Hdf5Id data(H5Dopen2(group, (spelling + name).c_str(), H5P_DEFAULT), H5Dclose);
      REQUIRE(data >= 0);
      hsize_t size = 0;
      const Hdf5Id space(H5Dget_space(data), H5Sclose);
      REQUIRE(H5Sget_simple_extent_dims(space, &size, nullptr) == 1);
      std::vector<double> numbers(size);
      CHECK(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) >= 0);
      return numbers;
    };
    const Hdf5Id text(H5Tcopy(H5T_C_S1), H5Tclose), type(H5Dopen2(group, "TransformType", H5P_DEFAULT), H5Dclose);
    H5Tset_size(text, H5T_VARIABLE);
    char* name = nullptr;
    REQUIRE(H5Dread(type, text, H5S_ALL, H5S_ALL, H5P_DEFAULT, &name) >= 0);
    ItkTransform& transform = read.emplace_back();
    transform.type = name;
    H5free_memory(name);
    if (transform.type.find("Composite") == 0) continue;  // it has no parameters of its own
    transform.fixed_parameters = values("FixedParameters");
    transform.parameters = values("Parameters");
  }
  return read;
}

}  // namespace

TEST_CASE("a transform is the same in HDF5, under both spellings of ITK's names") {
  const TemporaryFolder folder;
  Grid grid{{3, 4, 5}, {2, 2.5, 3}, {-10, 20, 30}, glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.4, glm::dvec3(1, 0, 0)))};
  const glm::dmat4 map = glm::translate(glm::rotate(glm::dmat4(1.0), 0.1, glm::dvec3(0, 1, 0)), glm::dvec3(4, -5, 6));
  const auto moved = [&](const glm::dvec3& p) { return glm::dvec3(map * glm::dvec4(p, 1)); };
  const ItkTransform field = itk_displacements(grid, moved);
  CHECK(field.type == "DisplacementFieldTransform_double_3_3");
  CHECK(std::vector(field.fixed_parameters.begin(), field.fixed_parameters.begin() + 9) ==
        std::vector<double>{3, 4, 5, -10, 20, 30, 2, 2.5, 3});
  CHECK(field.fixed_parameters[9 + 5] == grid.direction[2][1]);  // second row, third column
  const glm::dvec3 p = grid.patient_from_index({2, 1, 3}), by = moved(p) - p;
  for (int axis = 0; axis < 3; ++axis)
    CHECK(field.parameters[3 * (2 + 3 * (1 + 4 * 3)) + std::size_t(axis)] == Approx(by[axis]));
  for (const std::vector<ItkTransform>& transforms : {std::vector{field}, {itk_affine(map), field}}) {
    const std::string bytes = as_hdf5(transforms, "Converged");
    CHECK(bytes == as_hdf5(transforms, "Converged"));
    CHECK(bytes.find("Converged") != std::string::npos);
    folder.put("transform.h5", bytes);
    for (const char* spelling : {"Tranform", "Transform"}) {
      std::vector<ItkTransform> read = read_as_itk(folder.path / "transform.h5", spelling);
      if (transforms.size() > 1) {
        CHECK(read.front().type == "CompositeTransform_double_3_3");
        read.erase(read.begin());
      }
      REQUIRE(read.size() == transforms.size());
      for (std::size_t i = 0; i < read.size(); ++i) {
        CHECK(read[i].type == transforms[i].type);
        CHECK(read[i].fixed_parameters == transforms[i].fixed_parameters);
        CHECK(read[i].parameters == transforms[i].parameters);
      }
    }
  }
}

TEST_CASE("the scene places the sweep behind its transform") {
  const std::string scene = slicer_scene("Converged & \"sure\"", false);
  CHECK(scene.find("<TransformStorage id=\"vtkMRMLTransformStorageNode1\" fileName=\"sweep_from_ct.tfm\"/>") !=
        std::string::npos);
  CHECK(scene.find("fileName=\"ct.nrrd\"") != std::string::npos);
  const std::size_t sweep = scene.find("name=\"Sweep\"");
  REQUIRE(sweep != std::string::npos);
  CHECK(scene.find("transformNodeRef=\"vtkMRMLLinearTransformNode1\"") > sweep);
  CHECK(scene.find("Converged &amp; &quot;sure&quot;") != std::string::npos);
}

TEST_CASE("the scene of a deformed sweep places it behind the displacement field") {
  const std::string scene = slicer_scene("Converged", true);
  CHECK(scene.find("fileName=\"sweep_from_ct.nrrd\"") != std::string::npos);
  CHECK(scene.find("<GridTransform id=\"vtkMRMLGridTransformNode1\" name=\"ct_from_sweep\"") != std::string::npos);
  CHECK(scene.find("transformNodeRef=\"vtkMRMLGridTransformNode1\"") > scene.find("name=\"Sweep\""));
  CHECK(scene.find("LinearTransform") == std::string::npos);
}

TEST_CASE("displacements of both directions undo each other, also beyond the field") {
  const TemporaryFolder folder;
  FreeFormField field = field_over({{0, 0, 0}, {40, 30, 20}}, 20);
  for (std::size_t i = 0; i < field.control_mm.size(); ++i)
    field.control_mm[i] = 6.0 * glm::dvec3(std::sin(double(i)), std::cos(3.0 * double(i)), std::sin(5.0 * double(i)));
  const glm::dmat4 ct_from_sweep = glm::translate(glm::dmat4(1.0), glm::dvec3(100, -20, 7)) *
                                   glm::rotate(glm::dmat4(1.0), 0.3, glm::normalize(glm::dvec3(1, 2, 3)));
  const glm::dmat4 sweep_from_ct = glm::inverse(ct_from_sweep);
  const DeformationGrids grids = deformation_grids(field, ct_from_sweep);
  CHECK(grids.of_sweep.spacing == glm::dvec3(2.5));
  write_displacements(folder.path / "there.nrrd", grids.of_sweep,
                      [&](const glm::dvec3& p) { return glm::dvec3(ct_from_sweep * glm::dvec4(field.at(p), 1)); });
  write_displacements(folder.path / "back.nrrd", grids.of_ct,
                      [&](const glm::dvec3& p) { return field.inverse(glm::dvec3(sweep_from_ct * glm::dvec4(p, 1))); });
  // Reads a field as NRRD defines it, by its header alone.
  struct Read {
    std::string header;
    glm::ivec3 size{0};
    glm::dvec3 origin{0.0};
    std::vector<float> values;

    explicit Read(const std::string& bytes) : header(bytes.substr(0, bytes.find("\n\n") + 2)) {
      const auto field = [&](const char* name) {
        std::string text = header.substr(header.find(name) + std::string(name).size());
        for (char& c : text) c = c == '(' || c == ')' || c == ',' ? ' ' : c;
        return std::istringstream(text);
      };
      int components = 0;
      field("sizes: ") >> components >> size.x >> size.y >> size.z;
      CHECK(components == 3);
      field("space origin: ") >> origin.x >> origin.y >> origin.z;
      values.resize(3 * std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
      REQUIRE(bytes.size() == header.size() + values.size() * sizeof(float));
      std::memcpy(values.data(), bytes.data() + header.size(), values.size() * sizeof(float));
    }
    glm::dvec3 at(const glm::dvec3& p) const {
      const glm::dvec3 index = (p - origin) / 2.5, low = glm::floor(index), f = index - low;
      glm::dvec3 sum(0.0);
      for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2), i = glm::ivec3(low) + step;
        REQUIRE((i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < size.x && i.y < size.y && i.z < size.z));
        const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(step));
        const float* v =
            values.data() +
            3 * ((std::size_t(i.z) * std::size_t(size.y) + std::size_t(i.y)) * std::size_t(size.x) + std::size_t(i.x));
        sum += w.x * w.y * w.z * glm::dvec3(v[0], v[1], v[2]);
      }
      return p + sum;
    }
  };
  const Read there(read_file(folder.path / "there.nrrd")), back(read_file(folder.path / "back.nrrd"));
  for (const char* line : {"type: float\n", "dimension: 4\n", "space: left-posterior-superior\n",
                           "kinds: vector domain domain domain\n", "endian: little\n", "encoding: raw\n"})
    CHECK(there.header.find(line) != std::string::npos);
  for (const glm::dvec3& p :
       {glm::dvec3(0, 0, 0), glm::dvec3(17, 21, 9), glm::dvec3(39, 4, 18), glm::dvec3(-50, 20, 30)}) {
    const glm::dvec3 in_ct(ct_from_sweep * glm::dvec4(field.at(p), 1));
    // Linear between voxels of 2.5 mm, where the field bends by up to 6 mm over 20 mm.
    CHECK(glm::distance(there.at(p), in_ct) < 0.1);
    CHECK(glm::distance(back.at(in_ct), p) < 0.15);
  }
  CHECK(glm::distance(there.at({17, 21, 9}), glm::dvec3(ct_from_sweep * glm::dvec4(17, 21, 9, 1))) > 0.5);
}

TEST_CASE("a deformation that chance explains is reported as none") {
  FreeFormRegistration found;
  found.held_out_before = 0.4;
  found.held_out_after = 0.41;
  found.held_out_error = 0.01;
  CHECK(sentence_about(found).find(
            "No deformation: LC2 of the images that were not fitted went from 0.4000 to 0.4100") == 0);
  found.held_out_after = 0.45;
  found.most_mm = 5.25;
  found.least_jacobian = 0.81;
  CHECK(sentence_about(found).find("Deformation: ") == 0);
  CHECK(sentence_about(found).find("by up to 5.2 mm and does not fold: the least Jacobian is 0.81.") !=
        std::string::npos);
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
  const StartTransform found = start_from_landmarks(folder.put("landmarks.txt", text.str()).string());
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      CHECK(found.ct_from_sweep[column][row] == Approx(truth[column][row]).margin(1e-9));
  CHECK(found.landmark_error_mm.value() == Approx(0).margin(1e-9));
  // Two triangles with legs of 60 and 66 mm: with both centred, corners are 2, 2 and 8^(1/2) mm apart.
  const std::string wider = "0 0 0 0 0 0  60 0 0 66 0 0  0 60 0 0 66 0";
  CHECK(start_from_landmarks(folder.put("wider.txt", wider).string()).landmark_error_mm.value() ==
        Approx(std::sqrt((8 + 20 + 20) / 3.0)));
  const auto refused = [&](const std::string& bad, const std::string& sentence) {
    const std::string file = folder.put("bad.txt", bad).string();
    CHECK_THROWS_WITH(start_from_landmarks(file), Catch::Contains(sentence));
  };
  refused("1 2 3 4 5 6\n1 2 3", "it holds 9 numbers; write six per landmark, of three or more landmarks.");
  refused("1 2 3 4 5 six", "number 6: 'six' is not a number within 100 m of the origin; write six numbers");
  refused("1 2 3 4 5 nan", "number 6: 'nan' is not a number");
  refused("1e300 2 3 4 5 6", "number 1: '1e300' is not a number within 100 m");
  refused("0 0 0 0 0 0 1 1 1 1 1 1 2 2 2 2 2 2", "the landmarks lie on a line");
  // As above with legs of 180 mm in place of 66: twenty times as far apart, 80 mm.
  refused("0 0 0 0 0 0  60 0 0 180 0 0  0 60 0 0 180 0",
          "the landmarks' places do not fit each other: they stay 80 mm apart (root mean square); write each pair in");
  refused("0 0 0 0 0 0 50 0 0 1 1 1 0 50 0 2 2 2", "the landmarks lie on a line");
}

TEST_CASE("the pictures of a result are of images that show something, spread among these") {
  TrackedSweep sweep{Probe(*find_probe("linear")), 40, {}};
  for (int i = 0; i < 8; ++i) {
    SweepImage image{Pose{glm::dmat3(1.0), glm::dvec3(0, 0, i)}, Image<float>(40, 30)};
    const bool in_air = i < 4;  // a bright face and noise in the depth, and nothing between
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x)
        image.grey.at(x, y) = in_air ? (y < 3 ? 255.0F : y > 20 ? float(60 * (x % 2)) : 0.0F) : float(40 + x + y);
    sweep.images.push_back(std::move(image));
  }
  Volume<std::int16_t> ct;
  ct.grid.size = glm::ivec3(4);
  ct.voxels.resize(ct.grid.count());
  const TemporaryFolder folder;
  const glm::dmat4 same(1.0);
  const auto pictures = write_comparison(folder.path / "pictures", sweep, ct, same, same, nullptr, 2);
  REQUIRE(pictures.size() == 2);
  CHECK(pictures[0].image == 5);
  CHECK(pictures[1].image == 7);
  CHECK(pictures[0].blend_after == "pictures/6-blend-after.png");
  CHECK(std::filesystem::exists(folder.path / pictures[0].blend_after));
  // There are more pictures than such images, but not more than images.
  CHECK(write_comparison(folder.path / "all", sweep, ct, same, same, nullptr, 20).size() == 8);
}
