// insonate-bench: measures the simulator's run time on this machine, as medians with their spread, and its accuracy.

#include "sim/core/files.h"
#include "sim/imaging/upload.h"
#include "tools/bench/commands.h"
#include "tools/cli/program.h"

using namespace insonate;

namespace {

CLI::App* add_measurement(CLI::App& arguments, const char* name, const char* what, bench::Request& request,
                          std::string& csv) {
  CLI::App* command = arguments.add_subcommand(name, what);
  command->add_option("--case,--ct", request.subjects,
                      "Case folder, CT file or DICOM folder, once or more (the built-in abdomen)");
  command->add_flag("--built-in", request.built_in, "The built-in abdomen as well");
  command->add_option("--view", request.view, "A view by name (the first of each case)");
  command->add_option("--frames", request.frames, "Frames measured per setting")
      ->check(CLI::Range(3, 100000))
      ->capture_default_str();
  command
      ->add_option("--configuration", request.configurations,
                   "LINES,SAMPLES,WIDTH,HEIGHT, once or more, instead of the usual ones")
      ->delimiter(',')
      ->type_name("INT,INT,INT,INT");
  command->add_option("--csv", csv, "Write the table as CSV too");
  return command;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments("Measures what the simulator costs on this machine, and how exact it is.", "insonate-bench");
  arguments.require_subcommand(1);
  bench::Request request;
  std::string csv, svg, old_file, new_file;
  const CLI::App* frames =
      add_measurement(arguments, "frames", "What a frame costs, and each stage's share of it", request, csv);
  const CLI::App* paper = add_measurement(
      arguments, "paper", "The traversal against that of Kutter, Shams and Navab (2009), a render pass a sample",
      request, csv);
  const CLI::App* division = add_measurement(arguments, "work-division",
                                             "The traversal by an invocation a line and by a work group a line, of so "
                                             "many LINES and SAMPLES",
                                             request, csv);
  const CLI::App* batch = add_measurement(
      arguments, "batch", "Model W for registration: many images in one call against one a call", request, csv);
  const CLI::App* sweep =
      add_measurement(arguments, "sweep", "What a 3D probe's volume of WIDTH x HEIGHT x WIDTH costs", request, csv);
  CLI::App* denormal = arguments.add_subcommand("denormal", "What numbers near nothing cost, beside ordinary ones");
  denormal->add_option("--frames", request.frames, "Frames measured")
      ->check(CLI::Range(3, 100000))
      ->capture_default_str();
  denormal->add_option("--csv", csv, "Write the table as CSV too");
  CLI::App* filter = arguments.add_subcommand("filter", "How exact the device's own filter of volumes is");
  filter->add_option("--csv", csv, "Write the table as CSV too");
  CLI::App* front = add_measurement(arguments, "front", "Run time against error over the settings", request, csv);
  front->add_option("--svg", svg, "Draw the plot too");
  std::vector<std::string> exams;
  CLI::App* scoring = arguments.add_subcommand("scoring", "What a sample costs the runner of an exam, on one core");
  scoring->add_option("exams", exams, "Scenarios and recorded scans in turn (the bundled exam and its good scan)");
  scoring->add_option("--csv", csv, "Write the table as CSV too");
  CLI::App* compare = arguments.add_subcommand("compare", "How the run times of two CSVs differ, setting by setting");
  compare->add_option("old", old_file, "CSV of the earlier run")->required();
  compare->add_option("new", new_file, "CSV of the later run, of the same command")->required();

  return run_program(arguments, argc, argv, [&] {
    if (compare->parsed()) {
      bench::compare_runs(old_file, new_file);
      return 0;
    }
    if (exams.size() % 2 != 0) throw CLI::ValidationError("exams", "a scenario comes without a recorded scan");
    if (exams.empty())
      exams = {assets_folder() / "scenarios" / "ruq_hepatorenal.toml", assets_folder() / "logs" / "ruq_good.igs.mha"};
    bench::Table table;
    gl::within_device("--configuration", "take fewer lines, samples or pixels", [&] {
      table = frames->parsed()     ? bench::measure_frames(request)
              : paper->parsed()    ? bench::measure_paper(request)
              : division->parsed() ? bench::measure_work_divisions(request)
              : filter->parsed()   ? bench::measure_filter()
              : denormal->parsed() ? bench::measure_denormals(request)
              : sweep->parsed()    ? bench::measure_sweep(request)
              : batch->parsed()    ? bench::measure_batch(request)
              : scoring->parsed()  ? bench::measure_scoring(exams)
                                   : bench::measure_front(request, svg);
    });
    if (!csv.empty()) write_file(csv, table.csv());
    return 0;
  });
}
