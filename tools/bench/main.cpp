// insonate-bench: measures the simulator's run time on this machine, as medians with their spread, and its accuracy.

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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

/// What the measurements share.
struct Given {
  bench::Request request;
  std::string csv, svg;
};

/// What the chosen command does, set when it is parsed.
using Run = std::function<void()>;

CLI::App* add_command(CLI::App& arguments, const char* name, const char* what, Run& run, Run act) {
  CLI::App* command = arguments.add_subcommand(name, what);
  command->callback([&run, act = std::move(act)] { run = act; });
  return command;
}

/// Adds a command that measures a table, prints it, and writes it to --csv.
template <typename Measure>
CLI::App* add_table(CLI::App& arguments, const char* name, const char* what, Given& given, Run& run, Measure measure) {
  CLI::App* command = add_command(arguments, name, what, run, [&given, measure] {
    bench::Table table;
    gl::within_device("--configuration", "take fewer lines, samples or pixels", [&] { table = measure(); });
    if (!given.csv.empty()) write_file(given.csv, table.csv());
  });
  command->add_option("--csv", given.csv, "Write the table to this file too (CSV)")->type_name("FILE");
  return command;
}

void add_frames(CLI::App& command, Given& given, const char* what) {
  command.add_option("--frames", given.request.frames, what)->check(CLI::Range(3, 100000))->capture_default_str();
}

void add_svg(CLI::App& command, Given& given, const char* what) {
  command.add_option("--svg", given.svg, what)->type_name("FILE");
}

/// Adds such a command for patients: `measure` takes the bench::Request.
template <typename Measure>
CLI::App* add_measurement(CLI::App& arguments, const char* name, const char* what, Given& given, Run& run,
                          Measure measure) {
  CLI::App* command =
      add_table(arguments, name, what, given, run, [&given, measure] { return measure(given.request); });
  command
      ->add_option("--case,--ct", given.request.subjects,
                   "Measure this patient: a case folder, CT file or DICOM folder; may be repeated")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  command->add_flag("--built-in", given.request.built_in, "Measure the built-in patient as well");
  command->add_option("--view", given.request.view, "Measure this view of each case")
      ->type_name("NAME")
      ->default_str("the first view");
  add_frames(*command, given, "Measure this many frames per setting");
  command
      ->add_option("--configuration", given.request.configurations,
                   "Measure this configuration instead of the usual ones; may be repeated")
      ->delimiter(',')
      ->type_name("LINES,SAMPLES,WIDTH,HEIGHT");
  return command;
}

void add_simulation(CLI::App& arguments, Given& given, Run& run) {
  add_measurement(arguments, "frames",
                  "Measure the run time of a frame, and the share of each stage: in the paper's mode, in the trainer's "
                  "settings, and with what the trainer's machine adds to them",
                  given, run, bench::measure_frames);
  add_measurement(
      arguments, "paper",
      "Compare the traversal with that of Kutter, Shams and Navab (2009), which takes one render pass per sample",
      given, run, bench::measure_paper);
  add_measurement(arguments, "work-division",
                  "Compare the traversal by one invocation per line with that by one work group per line, for the "
                  "LINES and SAMPLES of each configuration",
                  given, run, bench::measure_work_divisions);
  add_measurement(arguments, "sweep", "Measure the run time of a 3D probe's volume of WIDTH x HEIGHT x WIDTH voxels",
                  given, run, bench::measure_sweep);
  CLI::App* front =
      add_measurement(arguments, "front", "Measure run time and error over the settings", given, run,
                      [&given](const bench::Request& request) { return bench::measure_front(request, given.svg); });
  add_svg(*front, given, "Draw the plot to this file too (SVG)");
  CLI::App* denormal =
      add_table(arguments, "denormal", "Compare the run time with numbers near 0 with that of ordinary numbers", given,
                run, [&given] { return bench::measure_denormals(given.request); });
  add_frames(*denormal, given, "Measure this many frames");
  add_table(arguments, "filter", "Measure the accuracy of the device's own filter of volumes", given, run,
            bench::measure_filter);
}

void add_model_w(CLI::App& arguments, Given& given, Run& run) {
  add_measurement(arguments, "batch",
                  "Compare many images of model W in one call, as for registration, with one image per call", given,
                  run, bench::measure_batch);
  CLI::App* throughput = add_measurement(
      arguments, "throughput",
      "Compare model W's images, single ones and up to 512 in one call, with the processor's own implementations",
      given, run, [&given](const bench::Request& request) { return bench::measure_throughput(request, given.svg); });
  add_svg(*throughput, given, "Draw the plots to this file too (SVG)");
}

void add_registration(CLI::App& arguments, Given& given, Run& run) {
  struct Wanted {
    bench::RegistrationRequest request;
    std::string table_file;
  };
  const auto wanted = std::make_shared<Wanted>();
  CLI::App* command = add_measurement(
      arguments, "registration", "Measure error, capture range and run time of the registration of synthetic sweeps",
      given, run, [&given, wanted](const bench::Request& request) {
        const std::string& file = wanted->table_file;
        bench::Table table = file.empty() ? bench::measure_registration(request, wanted->request)
                                          : bench::Table::parse(file, read_file(file));
        for (const char* column : {"case", "view", "measure", "start_error_mm"})
          if (std::ranges::find(table.columns, column) == table.columns.end())
            throw InputError(file, "", std::string("there is no column '") + column + "'",
                             "name a table of insonate-bench registration");
        const std::string name = file.empty() ? "the table" : file;
        bench::print_summaries(bench::summaries_of(name, table));
        if (!given.svg.empty()) write_file(given.svg, bench::registrations_svg(name, table));
        return table;
      });
  command->add_option("--starts", wanted->request.starts, "Register from this many starts")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--first-start", wanted->request.first_start,
                   "Begin with this start, for a measurement in several parts")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command
      ->add_option("--measure", wanted->request.measures,
                   "Register by this measure; may be repeated. With -local the search begins at the start alone")
      ->delimiter(',')
      ->check(CLI::IsMember({"lc2", "mi", "cr", "lc2-local", "mi-local", "cr-local"}))
      ->capture_default_str();
  command->add_option("--read", wanted->table_file, "Summarise this table of an earlier run (CSV) instead of measuring")
      ->type_name("FILE");
  add_svg(*command, given, "Draw the plot to this file too (SVG)");
}

void add_deformation(CLI::App& arguments, Given& given, Run& run) {
  const auto wanted = std::make_shared<bench::DeformationRequest>();
  CLI::App* command = add_measurement(
      arguments, "deformation", "Measure the error of registrations of patients that have breathed since the CT", given,
      run, [wanted](const bench::Request& request) { return bench::measure_deformation(request, *wanted); });
  command->add_option("--breath", wanted->breaths_mm, "Move the organs by up to this much, mm; may be repeated")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 15.0))
      ->capture_default_str();
  command->add_option("--spacing", wanted->settings.spacing_mm, "Place control points this far apart, mm")
      ->check(CLI::Range(8.0, 100.0))
      ->capture_default_str();
  command->add_option("--smoothness", wanted->settings.smoothness_mm2, "Set the weight of the bending energy, mm^2")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
}

void add_trainer(CLI::App& arguments, Given& given, Run& run) {
  add_measurement(arguments, "view",
                  "Measure simulation and volume rendering together, by what changes from frame to frame", given, run,
                  bench::measure_view);
  add_measurement(arguments, "view-front", "Measure run time and error of the volume rendering over its settings",
                  given, run, bench::measure_view_front);
  const auto sizes =
      std::make_shared<std::vector<std::string>>(std::vector<std::string>{"1280x720", "1600x1000", "2560x1440"});
  add_table(arguments, "window",
            "Measure the trainer's window: pictures per second, the cost at rest, and where the time goes", given, run,
            [sizes] { return bench::measure_window(sizes_of(*sizes)); })
      ->add_option("--size", *sizes, "Measure a window of this size, pixels; may be repeated")
      ->delimiter(',')
      ->type_name("WIDTHxHEIGHT")
      ->capture_default_str();
  const auto exams = std::make_shared<std::vector<std::string>>();
  add_table(arguments, "scoring", "Measure the run time of scoring one sample of an exam, on one core", given, run,
            [exams] {
              if (exams->size() % 2 != 0)
                throw CLI::ValidationError("FILE", "a scenario comes without a recorded scan");
              if (exams->empty())
                *exams = {assets_folder() / "scenarios" / "ruq_hepatorenal.toml",
                          assets_folder() / "logs" / "ruq_good.igs.mha"};
              return bench::measure_scoring(*exams);
            })
      ->add_option("FILE", *exams, "Score these files, each scenario followed by its recorded scan")
      ->type_name("FILE")
      ->default_str("the bundled exam and its good scan");
}

void add_transducers(CLI::App& command, bench::AcousticRequest& request) {
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

void add_waves(CLI::App& arguments, Given& given, Run& run) {
  const auto of_beam = std::make_shared<bench::AcousticRequest>();
  CLI::App* beam =
      add_table(arguments, "beam",
                "Measure the resolution cell of each transducer by depth, beside the widths of the live simulator",
                given, run, [&given, of_beam] { return bench::measure_beams(*of_beam, given.svg); });
  add_transducers(*beam, *of_beam);
  add_svg(*beam, given, "Draw the plots to this file too (SVG)");

  add_table(arguments, "grain",
            "Measure the speckle of the live simulator in a uniform block, beside what theory expects of it", given,
            run, bench::measure_grain);

  struct Speckle {
    bench::AcousticRequest request;
    int lines = 300;
    bool rates = false;
  };
  const auto of_speckle = std::make_shared<Speckle>();
  CLI::App* speckle =
      add_table(arguments, "speckle",
                "Measure the speckle that the sum over many scatterers gives for each transducer at its focus", given,
                run, [of_speckle] {
                  return of_speckle->rates ? bench::measure_scatterer_rates()
                                           : bench::measure_speckle(of_speckle->request, of_speckle->lines);
                });
  add_transducers(*speckle, of_speckle->request);
  speckle->add_flag("--rates", of_speckle->rates,
                    "Measure instead how many scatterers a second the live simulator adds up, and the direct sum");
  speckle->add_option("--lines", of_speckle->lines, "Measure this many scan lines per row")
      ->check(CLI::Range(10, 100000))
      ->capture_default_str();
}

void add_scene(CLI::App& arguments, Run& run) {
  struct Wanted {
    bench::AcousticRequest acoustics;
    SceneRequest request;
    std::string kind, folder;
  };
  const auto wanted = std::make_shared<Wanted>();
  CLI::App* command = add_command(
      arguments, "scene",
      "Write point scatterers and a transducer as text, for other simulators such as Field II and SIMUS", run,
      [wanted] {
        const auto kind = std::find(scene_names().begin(), scene_names().end(), wanted->kind) - scene_names().begin();
        wanted->request.kind = SceneKind(kind);
        bench::write_scenes(wanted->acoustics, wanted->request, wanted->folder);
      });
  command->add_option("KIND", wanted->kind, "Write this scene")->check(CLI::IsMember(scene_names()))->required();
  command->add_option("FOLDER", wanted->folder, "Write it to this new folder")->type_name("FOLDER")->required();
  add_transducers(*command, wanted->acoustics);
  command->add_option("--width", wanted->request.width_mm, "Make block and cysts this wide, mm")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  command->add_option("--per-cell", wanted->request.per_cell, "Put this many scatterers into a resolution cell")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  command->add_option("--seed", wanted->request.seed, "Place the scatterers by this seed")->capture_default_str();
}

void add_compare(CLI::App& arguments, Run& run) {
  struct Files {
    std::string before, after;
  };
  const auto files = std::make_shared<Files>();
  CLI::App* command = add_command(arguments, "compare", "Compare the run times of two CSV files, setting by setting",
                                  run, [files] { bench::compare_runs(files->before, files->after); });
  command->add_option("OLD", files->before, "Read this CSV file of the earlier run")->type_name("FILE")->required();
  command->add_option("NEW", files->after, "Read this CSV file of the later run of the same command")
      ->type_name("FILE")
      ->required();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments("Measure the simulator's run time and accuracy on this machine.", "insonate-bench");
  arguments.require_subcommand(1);
  Given given;
  Run run;
  add_simulation(arguments, given, run);
  add_trainer(arguments, given, run);
  add_model_w(arguments, given, run);
  add_registration(arguments, given, run);
  add_deformation(arguments, given, run);
  add_waves(arguments, given, run);
  add_scene(arguments, run);
  add_compare(arguments, run);
  return run_program(arguments, argc, argv, [&run] {
    run();
    return 0;
  });
}
