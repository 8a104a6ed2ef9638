// The extension module insonate._insonate; insonate/__init__.py presents it, and insonate/__init__.pyi describes it.

#include <dlfcn.h>
#include <pybind11/pybind11.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tools/python/bindings.h"
#include "tools/python/docs.h"

namespace insonate::python {
namespace {

/// Sets the path of the assets from the path of this module, in an install as in a build.
void find_assets() {
  Dl_info module;
  if (std::getenv("INSONATE_ASSETS") || dladdr(reinterpret_cast<void*>(&find_assets), &module) == 0) return;
  const std::filesystem::path folder = std::filesystem::path(module.dli_fname).parent_path();
  for (const char* way : {INSONATE_ASSETS_FROM_MODULE, INSONATE_ASSETS_FROM_BUILT_MODULE}) {
    std::error_code error;
    const std::filesystem::path assets = std::filesystem::weakly_canonical(folder / way, error);
    if (!std::filesystem::exists(assets / "tissues.toml", error)) continue;
    set_assets_folder(assets);
    return;
  }
}

}  // namespace

const TissueTable& tissues() {
  static const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
  return table;
}

}  // namespace insonate::python

PYBIND11_MODULE(_insonate, module) {
  using namespace insonate::python;
  find_assets();
  module.attr("__version__") = INSONATE_VERSION;
  pybind11::register_exception<insonate::InputError>(module, "InputError", PyExc_ValueError).attr("__doc__") =
      doc("InputError");
  // What the simulators refuse of a caller.
  static PyObject* const input_error = module.attr("InputError").ptr();
  pybind11::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const std::invalid_argument& error) {
      PyErr_SetString(input_error, error.what());
    }
  });
  bind_probes(module);
  bind_cases(module);
  bind_simulator(module);
  bind_similarity(module);
}
