#include <cstdio>
#include <filesystem>
#include <string>

#include "devices/sequence/probe_samples.h"
#include "scenarios/report.h"
#include "scenarios/result_json.h"
#include "scenarios/runner.h"
#include "scenarios/scenario.h"
#include "sim/core/files.h"
#include "sim/model/tissue.h"
#include "tools/program.h"
#include "tools/subject.h"

namespace {

using namespace insonate;

Case case_for(const Scenario& scenario, const std::filesystem::path& folder) {
  return folder.empty() ? load_case(scenario, assets_folder(), cache_folder(), show_progress) : open_case(folder);
}

struct Arguments {
  std::filesystem::path log;
  std::filesystem::path scenario;
  std::filesystem::path case_folder;
  std::filesystem::path report;
  std::string transform;
};

int score(const Arguments& given) {
  const Scenario scenario = read_scenario(given.scenario);
  const RecordedScan scan = read_recorded_scan(given.log, given.transform);
  const Case subject = case_for(scenario, given.case_folder);

  Runner runner(scenario, subject, read_tissue_table(assets_folder() / "tissues.toml"));
  runner.feed(scan.samples);
  runner.end();
  ExamResult result = runner.result();
  result.provenance.log = scan.recording.file;
  result.provenance.log_digest = scan.recording.digest;
  result.provenance.log_transform = scan.recording.transform;

  if (!given.report.empty()) write_file(given.report, report_html(result, runner.trace()));
  std::fputs(to_json(result).c_str(), stdout);
  return 0;
}

int check(const Arguments& given, bool without_case) {
  const Scenario scenario = read_scenario(given.scenario);
  if (!without_case) {
    // Building the runner checks the names against the case, and the case's views against themselves.
    const Case subject = case_for(scenario, given.case_folder);
    Runner(scenario, subject, read_tissue_table(assets_folder() / "tissues.toml"));
  }
  std::printf("%s: \"%s\", %zu steps: no problems found\n", given.scenario.string().c_str(), scenario.title.c_str(),
              scenario.steps.size());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments(
      "Scores a recorded scan against a scenario and prints the result as JSON. A failed exam is a result too: the "
      "exit code is 0 for it, and 2 for input that cannot be used.\n\n"
      "  insonate-score --log scan.igs.mha --scenario exam.toml --report scan.html\n"
      "  insonate-score check exam.toml",
      "insonate-score");
  Arguments given;
  arguments.add_option("--log", given.log, "The recorded scan, a PLUS/IGSIO sequence file (.igs.mha)");
  arguments.add_option("--scenario", given.scenario, "The scenario, a TOML file");
  arguments.add_option("--case,--ct", given.case_folder,
                       "A case folder, CT file or DICOM folder to take instead of the scenario's own case");
  arguments.add_option("--transform", given.transform,
                       "The probe's transform in the log, as in replay:FILE?transform=... (ProbeToPatient, "
                       "ProbeToReference or ProbeToTracker, the first that is there)");
  arguments.add_option("--report", given.report, "Also writes a report as one HTML page");

  bool without_case = false;
  CLI::App* check_command = arguments.add_subcommand("check", "Checks a scenario file and lists all its problems");
  check_command->add_option("file", given.scenario, "The scenario, a TOML file")->required();
  check_command->add_option("--case", given.case_folder, "A case folder to take instead of the scenario's own case");
  check_command->add_flag("--without-case", without_case, "Checks the text alone, not its names against the case");

  return run_program(arguments, argc, argv, [&] {
    if (*check_command) return check(given, without_case);
    if (given.log.empty()) throw CLI::RequiredError("--log");
    if (given.scenario.empty()) throw CLI::RequiredError("--scenario");
    return score(given);
  });
}
