// insonate-render: one pose of one patient to a PNG, without a window.

#include <nlohmann/json.hpp>

#include <cstdio>
#include <sstream>

#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/gl/headless_context.h"
#include "sim/gl/simulator.h"
#include "sim/gl/upload.h"
#include "tools/program.h"
#include "tools/subject.h"

using namespace insonate;

namespace {

/// A pose file: 16 numbers, row-major patient_from_probe, as JSON (an array, or an object with the array under
/// "patient_from_probe") or as plain text.
Pose read_pose(const std::string& file) {
  std::string text = read_file(file, 1u << 20);
  std::vector<double> numbers;
  if (const auto json = nlohmann::json::parse(text, nullptr, false); !json.is_discarded()) {
    for (const auto& value : json.is_object() ? json.value("patient_from_probe", nlohmann::json::array()) : json)
      if (value.is_number()) numbers.push_back(value.get<double>());
  } else {
    std::istringstream stream(text);
    for (double number; stream >> number;) numbers.push_back(number);
    if (!stream.eof()) numbers.clear();
  }
  if (numbers.size() != 16)
    throw InputError(file, "", "there are not 16 numbers",
                     "write the matrix patient_from_probe row by row, as text or JSON");
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i % 4][i / 4] = numbers[std::size_t(i)];
  if (const auto why = why_not_rigid(matrix))
    throw InputError(file, "", *why, "give a rotation and a translation in mm");
  return pose_from_matrix(matrix);
}

const ReferenceView& choose_view(const Case& subject, const std::string& path, const std::string& name) {
  std::vector<std::string> names;
  for (const ReferenceView& view : subject.views) names.push_back(view.name);
  if (names.empty()) throw InputError(path, "", "no view is marked and no body was found", "give a --pose");
  if (name.empty()) return subject.views.front();
  if (const ReferenceView* view = subject.find_view(name)) return *view;
  throw InputError("--view", "", "there is no view named '" + name + "'", suggest(name, names));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments("Renders one ultrasound image of a patient to a PNG, without a window.", "insonate-render");
  std::string subject_path, view_name, pose_file, probe_name = "curvilinear", out;
  double depth_mm = 0, gain_db = 0;
  int width = 640, height = 480;
  arguments.add_option("--case,--ct", subject_path, "A case folder, CT file or DICOM folder (the built-in abdomen)");
  arguments.add_option("--view", view_name, "A view of the case by name (its first)");
  arguments.add_option("--pose", pose_file, "A file with 16 numbers, row-major patient_from_probe, instead of a view");
  arguments.add_option("--probe", probe_name, "curvilinear or linear")->capture_default_str();
  arguments.add_option("--depth", depth_mm, "Imaging depth, mm (the view's or the probe's)")
      ->check(CLI::Range(10.0, 400.0));
  arguments.add_option("--gain", gain_db, "Gain, dB")->check(CLI::Range(-60.0, 60.0));
  arguments.add_option("--width", width, "Pixels")->check(CLI::Range(1, 8192))->capture_default_str();
  arguments.add_option("--height", height, "Pixels")->check(CLI::Range(1, 8192))->capture_default_str();
  arguments.add_option("image", out, "The PNG to write")->required();

  return run_program(arguments, argc, argv, [&] {
    const Probe* probe = find_probe(probe_name);
    if (!probe)
      throw InputError("--probe", "", "there is no probe named '" + probe_name + "'", "take curvilinear or linear");
    const Case subject = open_subject(subject_path);
    Pose pose;
    if (!pose_file.empty()) {
      pose = read_pose(pose_file);
    } else {
      const ReferenceView& view = choose_view(subject, subject_path, view_name);
      pose = view.patient_from_probe;
      if (depth_mm == 0) depth_mm = view.depth_mm;
    }
    if (depth_mm == 0) depth_mm = probe->depth_mm;

    Settings settings = trainer_settings(probe->frequency_mhz, depth_mm);
    settings.gain_db = gain_db;
    settings.image_width = width;
    settings.image_height = height;

    const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
    const gl::HeadlessContext context;
    gl::Simulator simulator;
    gl::upload_ct(subject_path, subject.ct.grid, [&] {
      simulator.set_volume(make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table), table);
    });
    simulator.set_probe(*probe, depth_mm);
    simulator.set_settings(settings);
    simulator.set_pose(pose);
    Image<Rgba8> image(width, height);
    simulator.image().read(GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data(), image.pixels.size() * sizeof(Rgba8));
    for (Rgba8& pixel : image.pixels) pixel[3] = 255;
    write_png(std::filesystem::path(out), image);
    return 0;
  });
}
