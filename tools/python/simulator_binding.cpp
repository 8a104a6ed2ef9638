#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/upload.h"
#include "sim/imaging/view_limits.h"
#include "sim/model/settings_file.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/truth/picture_truth.h"
#include "sim/volume/open_case.h"
#include "tools/python/arrays.h"
#include "tools/python/bindings.h"
#include "tools/python/docs.h"
#include "tools/python/graphics_thread.h"

namespace insonate::python {
namespace {

SettingValue setting_value(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  try {
    if (py::isinstance<py::array>(value) && value.cast<py::array>().ndim() > 0) {
      const auto numbers = array_from<Doubles>(py::reinterpret_borrow<py::object>(value), "settings");
      if (numbers.ndim() == 1) return std::vector<double>(numbers.data(), numbers.data() + numbers.size());
    }
    // Of NumPy too, whose numbers are none of Python's types.
    if (PyIndex_Check(value.ptr())) return py::int_(py::reinterpret_borrow<py::object>(value)).cast<std::int64_t>();
    if (PyNumber_Check(value.ptr()) && !py::isinstance<py::array>(value))
      return py::float_(py::reinterpret_borrow<py::object>(value)).cast<double>();
    return value.cast<std::vector<double>>();
  } catch (const py::cast_error&) {
  } catch (const py::error_already_set&) {
  }
  throw InputError("settings", "", std::string(py::str(value)) + " cannot be the value of a setting",
                   "give a number, True or False, a text, or a list of numbers");
}

/// What a picture is of. Each call takes a copy under Python's lock, because another thread may change it meanwhile.
struct State {
  Probe probe;
  double depth_mm = 0;
  Settings settings;
  Pose pose;
};

/// A simulator with its patient. Pictures are as clinics show them: the probe's marker on the left.
class SimulatorBinding {
public:
  explicit SimulatorBinding(CasePtr subject) : case_(std::move(subject)), truth_(case_->subject, tissues()) {
    const Case& patient = case_->subject;
    simulator_.open();
    AcousticVolume volume;
    {
      const py::gil_scoped_release without_lock;
      volume = make_acoustic_volume(patient.ct, patient.labels, tissue_by_label(patient), tissues(), true);
    }
    with([&](gl::Simulator& simulator) {
      gl::upload_ct(case_->source, volume.grid, [&] { simulator.set_volume(volume, tissues()); });
    });
    if (patient.views.empty()) {
      set_probe(py::str("curvilinear"), py::none());
    } else {
      const ReferenceView& view = patient.views.front();
      set_probe(py::str(view.probe), py::float_(view.depth_mm));
      state_.pose = view.patient_from_probe;
    }
  }

  void close() { simulator_.close(); }

  void set_probe(const py::object& given, const py::object& depth_mm) {
    simulator_.check_is_open(kName);
    const Probe probe = probe_of(given);
    const double depth = depth_mm.is_none() ? probe.depth_mm : number_of(depth_mm, "Simulator", "depth_mm");
    gl::check_probe("Simulator", probe, depth);
    Settings settings = trainer_settings(probe.frequency_mhz, depth);
    settings.image_width = state_.settings.image_width;
    settings.image_height = state_.settings.image_height;
    state_.probe = probe;
    state_.depth_mm = depth;
    state_.settings = settings;
  }

  py::dict settings() const {
    py::dict all;
    for (const auto& [name, value] : named_settings(state_.settings)) all[py::str(name)] = py::cast(value);
    return all;
  }

  void set(const py::kwargs& changes) {
    simulator_.check_is_open(kName);
    Settings settings = state_.settings;
    for (const auto& [key, value] : changes) {
      const std::string name = py::str(key);
      std::vector<std::string> known;
      for (const auto& [each, ignored] : named_settings(settings)) known.push_back(each);
      if (std::find(known.begin(), known.end(), name) == known.end())
        throw InputError("settings", "", "there is no setting '" + name + "'", suggest(name, known));
      if (const auto why = set_setting(settings, name, setting_value(value)))
        throw InputError("settings", "", *why, "give such a value");
    }
    state_.settings = settings;
  }

  py::array_t<double> pose() const { return array_of(state_.pose.matrix()); }
  void set_pose(const py::object& matrix) {
    simulator_.check_is_open(kName);
    state_.pose = pose_of(matrix);
  }

  py::array_t<std::uint8_t> image() {
    const State now = state_;
    Image<std::uint8_t> grey;
    with([&](gl::Simulator& simulator) {
      prepare(simulator, now);
      grey = read(simulator, now.settings);
    });
    return array_of(mirrored(grey));
  }

  /// Draws all poses in one call, and computes their labels at will.
  py::object images(const py::object& matrices, bool with_labels) {
    const std::vector<Pose> poses = poses_of(matrices);
    const State now = state_;
    const std::size_t pixels = std::size_t(now.settings.image_width) * std::size_t(now.settings.image_height);
    std::vector<std::uint8_t> grey(poses.size() * pixels);
    const auto keep = [&](std::vector<std::uint8_t>& all, std::size_t i, const Image<std::uint8_t>& image) {
      const Image<std::uint8_t> shown = mirrored(image);
      std::copy(shown.pixels.begin(), shown.pixels.end(), all.begin() + std::ptrdiff_t(i * pixels));
    };
    with([&](gl::Simulator& simulator) {
      prepare(simulator, now);
      for (std::size_t i = 0; i < poses.size(); ++i) {
        simulator.set_pose(poses[i]);
        keep(grey, i, read(simulator, now.settings));
      }
    });
    const std::vector<py::ssize_t> shape{py::ssize_t(poses.size()), now.settings.image_height,
                                         now.settings.image_width};
    if (!with_labels) return array_of(std::move(grey), shape);
    std::vector<std::uint8_t> label(grey.size()), visible(grey.size()), reach(grey.size());
    std::vector<float> skin_mm;
    {
      const py::gil_scoped_release without_lock;
      const std::lock_guard alone(truth_mutex_);
      truth_.set_view(now.probe, now.depth_mm, now.settings);
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const PictureTruth truth = truth_.at(poses[i]);
        keep(label, i, truth.label);
        keep(visible, i, truth.visible_label);
        keep(reach, i, truth.reach);
        skin_mm.insert(skin_mm.end(), truth.skin_mm.begin(), truth.skin_mm.end());
      }
    }
    py::dict all;
    all["image"] = array_of(std::move(grey), shape);
    all["label"] = array_of(std::move(label), shape);
    all["visible_label"] = array_of(std::move(visible), shape);
    all["reach"] = array_of(std::move(reach), shape);
    all["skin_mm"] = array_of(std::move(skin_mm), {py::ssize_t(poses.size()), py::ssize_t(now.probe.lines)});
    return all;
  }

  py::dict truth() {
    simulator_.check_is_open(kName);
    const State now = state_;
    PictureTruth truth;
    {
      const py::gil_scoped_release without_lock;
      const std::lock_guard alone(truth_mutex_);
      truth_.set_view(now.probe, now.depth_mm, now.settings);
      truth = truth_.at(now.pose);
    }
    py::dict all;
    all["label"] = array_of(mirrored(truth.label));
    all["visible_label"] = array_of(mirrored(truth.visible_label));
    all["reach"] = array_of(mirrored(truth.reach));
    const auto lines = py::ssize_t(truth.skin_mm.size());
    all["skin_mm"] = array_of(std::move(truth.skin_mm), {lines});
    return all;
  }

  py::dict stages() {
    const State now = state_;
    Stages<float> stages;
    with([&](gl::Simulator& simulator) {
      prepare(simulator, now);
      stages = simulator.read_stages();
    });
    py::dict all;
    // What the settings leave out, such as the waves without them, is empty.
    for (const auto& [name, of_lines] :
         std::initializer_list<std::pair<const char*, Image<float>*>>{{"intensity", &stages.intensity},
                                                                      {"reflection", &stages.reflection},
                                                                      {"reflection_beam", &stages.reflection_beam},
                                                                      {"transmission", &stages.transmission},
                                                                      {"repeated", &stages.repeated},
                                                                      {"speckle", &stages.speckle},
                                                                      {"scattered", &stages.scattered},
                                                                      {"echo_re", &stages.echo_re},
                                                                      {"echo_im", &stages.echo_im},
                                                                      {"wave_re", &stages.wave_re},
                                                                      {"wave_im", &stages.wave_im}})
      if (!of_lines->pixels.empty()) all[name] = array_of(std::move(*of_lines));
    all["fused"] = array_of(mirrored(stages.fused));
    all["inside"] = array_of(mirrored(stages.inside));
    all["image"] = array_of(mirrored(stages.grey));
    return all;
  }

  py::array_t<double> patient_from_pixel() const {
    const Settings& settings = state_.settings;
    const ImageGeometry geometry =
        image_geometry(state_.probe, state_.depth_mm, settings.image_width, settings.image_height);
    glm::dmat4 drawn_from_shown(1.0);
    drawn_from_shown[0][0] = -1;
    drawn_from_shown[3][0] = settings.image_width - 1;
    return array_of(python_matrix(geometry) * drawn_from_shown);
  }

  std::string device() {
    std::string text;
    with([&](gl::Simulator&) { text = gl::device_description(); });
    return text;
  }

  const Probe& probe() const { return state_.probe; }
  double depth_mm() const { return state_.depth_mm; }

private:
  static constexpr const char* kName = "simulator";

  template <typename Use>
  void with(const Use& use) {
    simulator_.with(kName, [&](gl::Simulator& simulator) {
      gl::within_device("settings", "take fewer samples, lines or pixels", [&] { use(simulator); });
    });
  }
  static void prepare(gl::Simulator& simulator, const State& now) {
    simulator.set_probe(now.probe, now.depth_mm);
    simulator.set_settings(now.settings);
    simulator.set_pose(now.pose);
  }
  static Image<std::uint8_t> read(gl::Simulator& simulator, const Settings& settings) {
    Image<std::uint8_t> grey(settings.image_width, settings.image_height);
    simulator.image().read(GL_RED, GL_UNSIGNED_BYTE, grey.pixels.data(), grey.pixels.size());
    return grey;
  }
  glm::dmat4 python_matrix(const ImageGeometry& geometry) const {
    return insonate::patient_from_pixel(geometry, state_.pose);
  }

  CasePtr case_;
  TruthMaker truth_;
  std::mutex truth_mutex_;  // which is taken without Python's lock
  OnGraphicsThread<gl::Simulator> simulator_;
  State state_;
};

}  // namespace

void bind_simulator(py::module_& module) {
  py::class_<SimulatorBinding>(module, "Simulator", doc("Simulator"))
      .def(py::init([](const py::object& held) { return std::make_unique<SimulatorBinding>(case_of(held)); }),
           py::arg("case"))
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](SimulatorBinding& self, const py::args&) { self.close(); })
      .def("close", &SimulatorBinding::close, doc("Simulator.close"))
      .def("set_probe", &SimulatorBinding::set_probe, py::arg("probe"), py::arg("depth_mm") = py::none(),
           doc("Simulator.set_probe"))
      .def_property_readonly("probe", &SimulatorBinding::probe)
      .def_property_readonly("depth_mm", &SimulatorBinding::depth_mm)
      .def_property_readonly("settings", &SimulatorBinding::settings, doc("Simulator.settings"))
      .def("set", &SimulatorBinding::set, doc("Simulator.set"))
      .def_property("pose", &SimulatorBinding::pose, &SimulatorBinding::set_pose, doc("Simulator.pose"))
      .def("image", &SimulatorBinding::image, doc("Simulator.image"))
      .def("images", &SimulatorBinding::images, py::arg("poses"), py::kw_only(), py::arg("labels") = false,
           doc("Simulator.images"))
      .def("truth", &SimulatorBinding::truth, doc("Simulator.truth"))
      .def("stages", &SimulatorBinding::stages, doc("Simulator.stages"))
      .def_property_readonly("patient_from_pixel", &SimulatorBinding::patient_from_pixel,
                             doc("Simulator.patient_from_pixel"))
      .def_property_readonly("device", &SimulatorBinding::device);
}

}  // namespace insonate::python
