#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "sim/probe/probe.h"
#include "sim/tissue/tissue.h"
#include "sim/volume/case.h"

namespace insonate::python {

/// A case as Python holds it: simulators keep it alive.
struct HeldCase {
  Case subject;
  std::string source;  ///< in error sentences
};
using CasePtr = std::shared_ptr<const HeldCase>;

/// Each adds its classes and functions to the module.
void bind_probes(pybind11::module_& module);
void bind_cases(pybind11::module_& module);
void bind_simulator(pybind11::module_& module);
void bind_similarity(pybind11::module_& module);

/// Returns the probe that a name or a Probe stands for. Throws InputError for an unknown name.
Probe probe_of(const pybind11::object& given);

/// Returns the number that an object of Python or NumPy is. Throws InputError if it is none.
/// @param of, name  whose number, in the error
/// @param wanted    what to give
double number_of(const pybind11::handle& given, const std::string& of, const std::string& name,
                 const std::string& wanted = "a number");
/// Returns the case that an object is. Throws TypeError for other objects.
CasePtr case_of(const pybind11::object& given);

/// Returns the bundled tissue table, read once.
const TissueTable& tissues();

}  // namespace insonate::python
