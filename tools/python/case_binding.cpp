#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/phantom/phantom.h"
#include "sim/volume/open_case.h"
#include "tools/python/arrays.h"
#include "tools/python/bindings.h"
#include "tools/python/docs.h"

namespace insonate::python {
namespace {

std::vector<py::ssize_t> shape_of(const Grid& grid) {
  return {grid.size.z, grid.size.y, grid.size.x};
}

std::shared_ptr<HeldCase> opened(const py::object& given) {
  std::filesystem::path path;
  try {
    path = given.cast<std::filesystem::path>();
  } catch (const py::cast_error&) {
    throw py::type_error("the path is " + std::string(py::repr(given)) + ", which names no file or folder");
  }
  const py::gil_scoped_release without_lock;
  return std::make_shared<HeldCase>(HeldCase{open_case(path), path.string()});
}

std::shared_ptr<HeldCase> made_phantom(const py::kwargs& given) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    if (py::isinstance<py::bool_>(value))
      options.emplace_back(name, value.cast<bool>() ? "true" : "false");
    else if (py::isinstance<py::str>(value))
      options.emplace_back(name, value.cast<std::string>());
    else
      options.emplace_back(name, exact_text(number_of(value, "phantom", name, "True, False, a number or a text")));
  }
  const py::gil_scoped_release without_lock;
  const std::filesystem::path recipe = assets_folder() / "phantoms" / "abdomen.toml";
  return std::make_shared<HeldCase>(HeldCase{cached_phantom(recipe, options, cache_folder()), "the built-in patient"});
}

}  // namespace

double number_of(const py::handle& given, const std::string& of, const std::string& name, const std::string& wanted) {
  try {
    const bool is_list = py::isinstance<py::array>(given) && given.cast<py::array>().ndim() > 0;
    if (PyNumber_Check(given.ptr()) && !is_list)
      return py::float_(py::reinterpret_borrow<py::object>(given)).cast<double>();
  } catch (const py::error_already_set&) {
  }
  throw InputError(of, "", "'" + name + "' is " + std::string(py::repr(given)) + ", which cannot be used",
                   "give " + wanted);
}

CasePtr case_of(const py::object& given) {
  if (py::isinstance<HeldCase>(given)) return given.cast<std::shared_ptr<HeldCase>>();
  throw py::type_error("the case is " + std::string(py::repr(given)) +
                       ", not a Case; take one from open_case() or phantom()");
}

void bind_cases(py::module_& module) {
  py::class_<ReferenceView>(module, "View", doc("View"))
      .def_readonly("name", &ReferenceView::name)
      .def_readonly("title", &ReferenceView::title)
      .def_readonly("probe", &ReferenceView::probe)
      .def_readonly("depth_mm", &ReferenceView::depth_mm)
      .def_readonly("landmarks", &ReferenceView::landmarks)
      .def_readonly("targets", &ReferenceView::targets)
      .def_property_readonly(
          "pose", [](const ReferenceView& view) { return array_of(view.patient_from_probe.matrix()); },
          doc("View.pose"))
      .def("__repr__", [](const ReferenceView& view) { return "<insonate.View " + view.name + ">"; });
  py::class_<HeldCase, std::shared_ptr<HeldCase>>(module, "Case", doc("Case"))
      .def_property_readonly("name", [](const HeldCase& held) { return held.subject.name; })
      .def_property_readonly("views",
                             [](const HeldCase& held) {
                               py::dict views;
                               for (const ReferenceView& view : held.subject.views) views[py::str(view.name)] = view;
                               return views;
                             })
      .def_property_readonly("label_names",
                             [](const HeldCase& held) {
                               py::dict names;
                               for (const Label& label : held.subject.label_table)
                                 names[py::int_(label.value)] = label.name;
                               return names;
                             })
      .def_property_readonly(
          "landmarks",
          [](const HeldCase& held) {
            py::dict landmarks;
            for (const Landmark& landmark : held.subject.landmarks) {
              const glm::dvec3& p = landmark.position;
              landmarks[py::str(landmark.name)] = py::make_tuple(p.x, p.y, p.z);
            }
            return landmarks;
          },
          doc("Case.landmarks"))
      .def_property_readonly(
          "ct",
          [](const std::shared_ptr<HeldCase>& held) {
            const Volume<std::int16_t>& ct = held->subject.ct;
            return shared_array(ct.voxels, shape_of(ct.grid), py::cast(held));
          },
          doc("Case.ct"))
      .def_property_readonly(
          "labels",
          [](const std::shared_ptr<HeldCase>& held) -> py::object {
            const Volume<std::uint8_t>& labels = held->subject.labels;
            if (labels.empty()) return py::none();
            return shared_array(labels.voxels, shape_of(labels.grid), py::cast(held));
          },
          doc("Case.labels"))
      .def_property_readonly(
          "patient_from_voxel", [](const HeldCase& held) { return array_of(held.subject.ct.grid.matrix()); },
          doc("Case.patient_from_voxel"))
      .def("__repr__", [](const HeldCase& held) { return "<insonate.Case " + held.subject.name + ">"; });
  module.def("open_case", &opened, py::arg("path"), doc("open_case"));
  module.def("phantom", &made_phantom, doc("phantom"));
}

}  // namespace insonate::python
