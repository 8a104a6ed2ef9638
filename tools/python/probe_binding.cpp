#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/imaging/view_limits.h"
#include "tools/python/bindings.h"
#include "tools/python/docs.h"

namespace insonate::python {
namespace {

namespace py = pybind11;

const std::vector<std::string> kKinds{"linear", "curvilinear", "phased"};

int whole(double number, const std::string& name) {
  constexpr double kMost = 1e6;  // of what an int holds; what a probe may have is checked afterwards
  if (number == std::trunc(number)) return int(std::clamp(number, -kMost, kMost));
  throw InputError("Probe", "", "'" + name + "' is " + number_text(number) + ", which is not a count",
                   "give a whole number");
}

// Refuses a part of the geometry that a probe of this kind does not have. It would change nothing.
void check_has(const Probe& probe, const std::string& name) {
  const bool is_curved = probe.kind == ProbeKind::curvilinear, is_linear = probe.kind == ProbeKind::linear;
  if ((name == "radius_mm" && !is_curved) || (name == "field_of_view_deg" && is_linear) ||
      (name == "width_mm" && is_curved))
    throw InputError("Probe", "", "a " + kKinds.at(std::size_t(probe.kind)) + " probe has no '" + name + "'",
                     is_curved   ? "give radius_mm and field_of_view_deg"
                     : is_linear ? "give width_mm"
                                 : "give width_mm and field_of_view_deg");
}

Probe made(const std::string& like, const py::kwargs& changes) {
  Probe probe = probe_of(py::str(like));
  for (const auto& [key, value] : changes) {
    const std::string name = py::str(key);
    check_has(probe, name);
    if (name == "radius_mm")
      probe.radius_mm = number_of(value, "Probe", name);
    else if (name == "field_of_view_deg")
      probe.field_of_view_deg = number_of(value, "Probe", name);
    else if (name == "width_mm")
      probe.width_mm = number_of(value, "Probe", name);
    else if (name == "aperture_mm")
      probe.aperture_mm = number_of(value, "Probe", name);
    else if (name == "frequency_mhz")
      probe.frequency_mhz = number_of(value, "Probe", name);
    else if (name == "depth_mm")
      probe.depth_mm = number_of(value, "Probe", name);
    else if (name == "lines")
      probe.lines = whole(number_of(value, "Probe", name), name);
    else
      throw InputError("Probe", "", "a probe has no '" + name + "'",
                       suggest(name, {"radius_mm", "field_of_view_deg", "width_mm", "aperture_mm", "frequency_mhz",
                                      "depth_mm", "lines"}));
  }
  gl::check_probe("Probe", probe, probe.depth_mm);
  return probe;
}

}  // namespace

Probe probe_of(const py::object& given) {
  if (py::isinstance<Probe>(given)) return given.cast<Probe>();
  if (!py::isinstance<py::str>(given)) throw py::type_error("a probe is given by its name or as a Probe");
  const std::string name = given.cast<std::string>();
  if (const Probe* probe = find_probe(name)) return *probe;
  throw InputError("probe", "", "there is no probe named '" + name + "'", suggest(name, probe_names()));
}

void bind_probes(py::module_& module) {
  py::class_<Probe>(module, "Probe", doc("Probe"))
      .def(py::init(&made), py::arg("like"))
      .def_readonly("name", &Probe::name)
      .def_property_readonly("kind", [](const Probe& probe) { return kKinds.at(std::size_t(probe.kind)); })
      .def_readonly("radius_mm", &Probe::radius_mm)
      .def_readonly("field_of_view_deg", &Probe::field_of_view_deg)
      .def_readonly("width_mm", &Probe::width_mm)
      .def_readonly("aperture_mm", &Probe::aperture_mm, doc("Probe.aperture_mm"))
      .def_readonly("frequency_mhz", &Probe::frequency_mhz)
      .def_readonly("depth_mm", &Probe::depth_mm, doc("Probe.depth_mm"))
      .def_readonly("lines", &Probe::lines)
      .def("__repr__", [](const Probe& probe) { return "<insonate.Probe " + probe.name + ">"; });
  module.def("probe_names", &probe_names, doc("probe_names"));
}

}  // namespace insonate::python
