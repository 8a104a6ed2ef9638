// insonate-bench: measures the simulator's run time on this machine, as medians with their spread, and its accuracy.

#include <algorithm>
#include <cstdio>

#include "sim/acoustics/scenes.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/imaging/upload.h"
#include "sim/probe/probe.h"
#include "tools/bench/acoustics.h"
#include "tools/bench/commands.h"
#include "tools/bench/registration_summary.h"
#include "tools/cli/program.h"

using namespace insonate;

namespace {

CLI::App* add_measurement(CLI::App& arguments, const char* name, const char* what, bench::Request& request,
                          std::string& csv) {
  CLI::App* command = arguments.add_subcommand(name, what);
  command
      ->add_option("--case,--ct", request.subjects,
                   "Measure this patient: a case folder, CT file or DICOM folder; may be repeated")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  command->add_flag("--built-in", request.built_in, "Measure the built-in patient as well");
  command->add_option("--view", request.view, "Measure this view of each case")
      ->type_name("NAME")
      ->default_str("the first view");
  command->add_option("--frames", request.frames, "Measure this many frames per setting")
      ->check(CLI::Range(3, 100000))
      ->capture_default_str();
  command
      ->add_option("--configuration", request.configurations,
                   "Measure this configuration instead of the usual ones; may be repeated")
      ->delimiter(',')
      ->type_name("LINES,SAMPLES,WIDTH,HEIGHT");
  command->add_option("--csv", csv, "Write the table to this file too (CSV)")->type_name("FILE");
  return command;
}

void add_acoustics(CLI::App& command, bench::AcousticRequest& request) {
  CLI::Option* probe = command.add_option("--probe", request.probes, "Take this probe's transducer; may be repeated")
                           ->check(CLI::IsMember(probe_names()))
                           ->default_str("all");
  command.add_option("--transducer", request.transducer, "Take this transducer's file (TOML) instead")
      ->type_name("FILE")
      ->excludes(probe);
  command.add_option("--depth", request.depth_mm, "Reach to this depth, mm")
      ->check(CLI::Range(10.0, 400.0))
      ->default_str("the probe's");
  command.add_option("--focus", request.focus_mm, "Transmit to this focus, mm")
      ->check(CLI::Range(5.0, 400.0))
      ->default_str("half the depth");
  command.add_option("--f-number", request.f_number, "Take this f-number for transmission and reception")
      ->check(CLI::Range(0.5, 30.0))
      ->capture_default_str();
  command.add_option("--attenuation", request.attenuation_db_cm_mhz, "Attenuate by this much, dB/(cm MHz)")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
}

std::vector<bench::WindowSize> sizes_of(const std::vector<std::string>& texts) {
  std::vector<bench::WindowSize> sizes;
  for (const std::string& text : texts) {
    bench::WindowSize size{};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &rest) != 2)
      throw InputError("command line", "--size", "'" + text + "' is not a size", "give one such as 1280x720");
    sizes.push_back(size);
  }
  return sizes;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments("Measure the simulator's run time and accuracy on this machine.", "insonate-bench");
  arguments.require_subcommand(1);
  bench::Request request;
  std::string csv, svg, old_file, new_file;
  const CLI::App* frames = add_measurement(arguments, "frames",
                                           "Measure the run time of a frame, and the share of each stage: in the "
                                           "paper's mode, in the trainer's settings, and "
                                           "with what the trainer's machine adds to them",
                                           request, csv);
  const CLI::App* paper = add_measurement(
      arguments, "paper",
      "Compare the traversal with that of Kutter, Shams and Navab (2009), which takes one render pass per sample",
      request, csv);
  const CLI::App* division = add_measurement(arguments, "work-division",
                                             "Compare the traversal by one invocation per line with that by one work "
                                             "group per line, for the LINES and SAMPLES of each configuration",
                                             request, csv);
  const CLI::App* batch = add_measurement(
      arguments, "batch", "Compare many images of model W in one call, as for registration, with one image per call",
      request, csv);
  CLI::App* throughput = add_measurement(
      arguments, "throughput",
      "Compare model W's images, single ones and up to 512 in one call, with the processor's own implementations",
      request, csv);
  throughput->add_option("--svg", svg, "Draw the plots to this file too (SVG)")->type_name("FILE");
  const CLI::App* sweep = add_measurement(
      arguments, "sweep", "Measure the run time of a 3D probe's volume of WIDTH x HEIGHT x WIDTH voxels", request, csv);
  bench::RegistrationRequest registration_request;
  CLI::App* registration = add_measurement(
      arguments, "registration", "Measure error, capture range and run time of the registration of synthetic sweeps",
      request, csv);
  registration->add_option("--starts", registration_request.starts, "Register from this many starts")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  registration
      ->add_option("--first-start", registration_request.first_start,
                   "Begin with this start, for a measurement in several parts")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  registration
      ->add_option("--measure", registration_request.measures,
                   "Register by this measure; may be repeated. With -local the search begins at the start alone")
      ->delimiter(',')
      ->check(CLI::IsMember({"lc2", "mi", "cr", "lc2-local", "mi-local", "cr-local"}))
      ->capture_default_str();
  registration->add_option("--read", old_file, "Summarise this table of an earlier run (CSV) instead of measuring")
      ->type_name("FILE");
  registration->add_option("--svg", svg, "Draw the plot to this file too (SVG)")->type_name("FILE");
  bench::DeformationRequest deformation_request;
  CLI::App* deformation =
      add_measurement(arguments, "deformation",
                      "Measure the error of registrations of patients that have breathed since the CT", request, csv);
  deformation
      ->add_option("--breath", deformation_request.breaths_mm,
                   "Move the organs by up to this much, mm; may be repeated")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 15.0))
      ->capture_default_str();
  deformation
      ->add_option("--spacing", deformation_request.settings.spacing_mm, "Place control points this far apart, mm")
      ->check(CLI::Range(8.0, 100.0))
      ->capture_default_str();
  deformation
      ->add_option("--smoothness", deformation_request.settings.smoothness_mm2,
                   "Set the weight of the bending energy, mm^2")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  CLI::App* denormal =
      arguments.add_subcommand("denormal", "Compare the run time with numbers near 0 with that of ordinary numbers");
  denormal->add_option("--frames", request.frames, "Measure this many frames")
      ->check(CLI::Range(3, 100000))
      ->capture_default_str();
  denormal->add_option("--csv", csv, "Write the table to this file too (CSV)")->type_name("FILE");
  CLI::App* filter = arguments.add_subcommand("filter", "Measure the accuracy of the device's own filter of volumes");
  filter->add_option("--csv", csv, "Write the table to this file too (CSV)")->type_name("FILE");
  CLI::App* front = add_measurement(arguments, "front", "Measure run time and error over the settings", request, csv);
  front->add_option("--svg", svg, "Draw the plot to this file too (SVG)")->type_name("FILE");
  const CLI::App* view = add_measurement(
      arguments, "view", "Measure simulation and volume rendering together, by what changes from frame to frame",
      request, csv);
  const CLI::App* view_front = add_measurement(
      arguments, "view-front", "Measure run time and error of the volume rendering over its settings", request, csv);
  std::vector<std::string> exams;
  CLI::App* scoring =
      arguments.add_subcommand("scoring", "Measure the run time of scoring one sample of an exam, on one core");
  scoring->add_option("FILE", exams, "Score these files, each scenario followed by its recorded scan")
      ->type_name("FILE")
      ->default_str("the bundled exam and its good scan");
  scoring->add_option("--csv", csv, "Write the table to this file too (CSV)")->type_name("FILE");
  std::vector<std::string> window_sizes{"1280x720", "1600x1000", "2560x1440"};
  CLI::App* window = arguments.add_subcommand(
      "window", "Measure the trainer's window: pictures per second, the cost at rest, and where the time goes");
  window->add_option("--size", window_sizes, "Measure a window of this size, pixels; may be repeated")
      ->delimiter(',')
      ->type_name("WIDTHxHEIGHT")
      ->capture_default_str();
  window->add_option("--csv", csv, "Write the table to this file too (CSV)")->type_name("FILE");
  bench::AcousticRequest acoustics;
  CLI::App* beam = arguments.add_subcommand(
      "beam", "Measure the resolution cell of each transducer by depth, beside the widths of the live simulator");
  add_acoustics(*beam, acoustics);
  beam->add_option("--csv", csv, "Write the table to this file too (CSV)")->type_name("FILE");
  beam->add_option("--svg", svg, "Draw the plots to this file too (SVG)")->type_name("FILE");
  CLI::App* grain = arguments.add_subcommand(
      "grain", "Measure the speckle of the live simulator in a uniform block, beside what theory expects of it");
  grain->add_option("--csv", csv, "Write the table to this file too (CSV)")->type_name("FILE");
  int speckle_lines = 300;
  CLI::App* speckle = arguments.add_subcommand(
      "speckle", "Measure the speckle that the sum over many scatterers gives for each transducer at its focus");
  add_acoustics(*speckle, acoustics);
  bool rates = false;
  speckle->add_flag("--rates", rates,
                    "Measure instead how many scatterers a second the live simulator adds up, and the direct sum");
  speckle->add_option("--lines", speckle_lines, "Measure this many scan lines per row")
      ->check(CLI::Range(10, 100000))
      ->capture_default_str();
  speckle->add_option("--csv", csv, "Write the table to this file too (CSV)")->type_name("FILE");
  SceneRequest scene_request;
  std::string scene_kind, scene_folder;
  CLI::App* scene = arguments.add_subcommand(
      "scene", "Write point scatterers and a transducer as text, for other simulators such as Field II and SIMUS");
  scene->add_option("KIND", scene_kind, "Write this scene")->check(CLI::IsMember(scene_names()))->required();
  scene->add_option("FOLDER", scene_folder, "Write it to this new folder")->type_name("FOLDER")->required();
  add_acoustics(*scene, acoustics);
  scene->add_option("--width", scene_request.width_mm, "Make block and cysts this wide, mm")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  scene->add_option("--per-cell", scene_request.per_cell, "Put this many scatterers into a resolution cell")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  scene->add_option("--seed", scene_request.seed, "Place the scatterers by this seed")->capture_default_str();
  CLI::App* compare = arguments.add_subcommand("compare", "Compare the run times of two CSV files, setting by setting");
  compare->add_option("OLD", old_file, "Read this CSV file of the earlier run")->type_name("FILE")->required();
  compare->add_option("NEW", new_file, "Read this CSV file of the later run of the same command")
      ->type_name("FILE")
      ->required();

  return run_program(arguments, argc, argv, [&] {
    if (compare->parsed()) {
      bench::compare_runs(old_file, new_file);
      return 0;
    }
    if (scene->parsed()) {
      const auto kind = std::find(scene_names().begin(), scene_names().end(), scene_kind) - scene_names().begin();
      scene_request.kind = SceneKind(kind);
      bench::write_scenes(acoustics, scene_request, scene_folder);
      return 0;
    }
    if (exams.size() % 2 != 0) throw CLI::ValidationError("FILE", "a scenario comes without a recorded scan");
    if (exams.empty())
      exams = {assets_folder() / "scenarios" / "ruq_hepatorenal.toml", assets_folder() / "logs" / "ruq_good.igs.mha"};
    bench::Table table;
    gl::within_device("--configuration", "take fewer lines, samples or pixels", [&] {
      table = frames->parsed()         ? bench::measure_frames(request)
              : paper->parsed()        ? bench::measure_paper(request)
              : division->parsed()     ? bench::measure_work_divisions(request)
              : filter->parsed()       ? bench::measure_filter()
              : denormal->parsed()     ? bench::measure_denormals(request)
              : deformation->parsed()  ? bench::measure_deformation(request, deformation_request)
              : registration->parsed() ? (old_file.empty() ? bench::measure_registration(request, registration_request)
                                                           : bench::Table::parse(old_file, read_file(old_file)))
              : sweep->parsed()        ? bench::measure_sweep(request)
              : batch->parsed()        ? bench::measure_batch(request)
              : throughput->parsed()   ? bench::measure_throughput(request, svg)
              : grain->parsed()        ? bench::measure_grain()
              : beam->parsed()         ? bench::measure_beams(acoustics, svg)
              : speckle->parsed()
                  ? (rates ? bench::measure_scatterer_rates() : bench::measure_speckle(acoustics, speckle_lines))
              : scoring->parsed()    ? bench::measure_scoring(exams)
              : view->parsed()       ? bench::measure_view(request)
              : view_front->parsed() ? bench::measure_view_front(request)
              : window->parsed()     ? bench::measure_window(sizes_of(window_sizes))
                                     : bench::measure_front(request, svg);
    });
    if (registration->parsed()) {
      const std::string name = old_file.empty() ? "the table" : old_file;
      bench::print_summaries(bench::summaries_of(name, table));
      if (!svg.empty()) write_file(svg, bench::registrations_svg(name, table));
    }
    if (!csv.empty()) write_file(csv, table.csv());
    return 0;
  });
}
