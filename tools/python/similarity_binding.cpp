#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

#include "sim/core/input_error.h"
#include "sim/imaging/upload.h"
#include "sim/imaging/view_limits.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/volume/open_case.h"
#include "sim/wein/wein_settings_file.h"
#include "sim/wein/wein_simulator.h"
#include "tools/python/arrays.h"
#include "tools/python/bindings.h"
#include "tools/python/docs.h"
#include "tools/python/graphics_thread.h"

namespace insonate::python {
namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// Compares an ultrasound image with images of model W.
class SimilarityBinding {
public:
  SimilarityBinding(const CasePtr& held, const py::object& picture, const py::object& given, const py::object& depth_mm,
                    const std::optional<std::filesystem::path>& settings_file, std::optional<int> patch) {
    const auto ultrasound = array_from<Floats>(picture, "ultrasound");
    if (ultrasound.ndim() != 2)
      throw InputError("ultrasound", "", "it is not an array of rows by columns", "give one grey image");
    const Probe probe = probe_of(given);
    const double depth = depth_mm.is_none() ? probe.depth_mm : number_of(depth_mm, "ImageSimilarity", "depth_mm");
    gl::check_probe("ImageSimilarity", probe, depth);
    WeinSettings settings = settings_file ? read_wein_settings(*settings_file) : WeinSettings{};
    settings.image_width = int(ultrasound.shape(1));
    settings.image_height = int(ultrasound.shape(0));
    // The share of the picture that insonate-register's patches have.
    if (!settings_file) settings.similarity_patch = std::clamp(settings.image_width / 16, kMinPatch, kMaxPatch);
    if (patch) {
      settings.similarity_patch = *patch;
      if (const auto why = why_not_valid(settings)) throw InputError("patch", "", *why, "give 0, or 4 to 128");
    }
    if (const auto why = why_not_valid(settings))
      throw InputError(settings_file ? settings_file->string() : "ultrasound", "", *why, "give another size or file");
    const std::span values(ultrasound.data(), std::size_t(ultrasound.size()));
    if (std::ranges::any_of(values, [](float each) { return std::isinf(each); }))
      throw InputError("ultrasound", "", "it has infinite values", "replace them, or exclude them by NaN");
    const auto first = std::ranges::find_if_not(values, [](float each) { return std::isnan(each); });
    if (std::all_of(first, values.end(), [&](float each) { return std::isnan(each) || each == *first; }))
      throw InputError("ultrasound", "", "its pixels have one grey level or none, so nothing can be compared",
                       "give an image of tissue");
    Image<float> image(settings.image_width, settings.image_height);
    std::ranges::copy(values, image.pixels.begin());
    const Case& patient = held->subject;
    AcousticVolume volume;
    {
      const py::gil_scoped_release without_lock;
      volume = make_acoustic_volume(patient.ct, patient.labels, tissue_by_label(patient), tissues());
    }
    gl::within_device("ultrasound", "take a smaller image", [&] { simulator_.open(volume, probe, depth, settings); });
    simulator_.with("comparison", [&](gl::WeinSimulator& simulator) { simulator.set_ultrasound(mirrored(image)); });
  }

  void close() { simulator_.close(); }

  py::array_t<float> similarity(const py::object& matrices) {
    const std::vector<Pose> poses = poses_of(matrices);
    std::vector<float> values;
    simulator_.with("comparison", [&](gl::WeinSimulator& simulator) { values = simulator.similarity(poses); });
    return array_of(std::move(values), {py::ssize_t(poses.size())});
  }

private:
  OnGraphicsThread<gl::WeinSimulator> simulator_;
};

}  // namespace

void bind_similarity(py::module_& module) {
  py::class_<SimilarityBinding>(module, "ImageSimilarity", doc("ImageSimilarity"))
      .def(py::init([](const py::object& held, const py::object& ultrasound, const py::object& probe,
                       const py::object& depth_mm, const std::optional<std::filesystem::path>& settings,
                       std::optional<int> patch) {
             return std::make_unique<SimilarityBinding>(case_of(held), ultrasound, probe, depth_mm, settings, patch);
           }),
           py::arg("case"), py::arg("ultrasound"), py::arg("probe"), py::arg("depth_mm") = py::none(),
           py::arg("settings") = py::none(), py::arg("patch") = py::none(), doc("ImageSimilarity.__init__"))
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](SimilarityBinding& self, const py::args&) { self.close(); })
      .def("close", &SimilarityBinding::close, doc("ImageSimilarity.close"))
      .def("similarity", &SimilarityBinding::similarity, py::arg("poses"), doc("ImageSimilarity.similarity"));
}

}  // namespace insonate::python
