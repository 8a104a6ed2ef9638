#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "devices/calibrated_tracker.h"
#include "devices/replay/read_log.h"
#include "scenarios/report/report.h"
#include "scenarios/result_json.h"
#include "scenarios/results/learner_id.h"
#include "scenarios/results/results_database.h"
#include "scenarios/runner.h"
#include "scenarios/scenario.h"
#include "sim/core/files.h"
#include "sim/model/tissue.h"
#include "tools/cli/program.h"
#include "tools/score/attempt_cases.h"
#include "tools/score/commands.h"

namespace {

using namespace insonate;

struct Arguments {
  std::filesystem::path log;
  std::filesystem::path scenario;
  std::filesystem::path case_folder;
  std::filesystem::path report;
  std::string transform;
  std::filesystem::path calibration;
  std::filesystem::path results;
  std::string learner = kNobodyInParticular;
  std::uint32_t seed = 0;
};

void keep(ResultsDatabase& results, const Arguments& given, Attempt attempt) {
  attempt.learner = given.learner;
  attempt.finished_ms = now_since_1970_ms();
  if (!given.case_folder.empty()) attempt.patient = std::filesystem::absolute(given.case_folder).string();
  results.add(attempt);
}

RecordedScan scan_of_probe(const Arguments& given) {
  RecordingOptions of_log;
  of_log.transform = given.transform;
  RecordedScan scan = read_log(given.log, of_log);
  if (!given.calibration.empty())
    scan = calibrated(std::move(scan), read_complete_calibration(given.calibration),
                      given.calibration.filename().string());
  check_is_of_probe(scan.recording);
  return scan;
}

int score(const Arguments& given) {
  check_learner_id(given.learner, "command line", "--learner");
  const Scenario scenario = read_scenario(given.scenario, given.seed);
  const RecordedScan scan = scan_of_probe(given);
  const ActionLog actions = parse_action_log(scan.recording.actions, given.log.string());
  const TissueTable tissues = read_tissue_table(assets_folder() / "tissues.toml");
  // The patient is read last, because it may take a minute to build.
  std::optional<ResultsDatabase> results;
  if (std::error_code error; std::filesystem::exists(given.results, error))
    results = ResultsDatabase::open(given.results);
  const Case subject = case_of(scenario, given.case_folder);

  Runner runner(scenario, subject, tissues);
  runner.feed(scan.samples, actions);
  runner.end();
  ExamResult result = runner.result();
  result.provenance.mode = AttemptMode::recording;
  result.provenance.log = scan.recording.file;
  result.provenance.log_digest = scan.recording.digest;
  result.provenance.log_transform = scan.recording.transform;

  if (!given.results.empty()) {
    if (!results) results = ResultsDatabase::open_or_make(given.results);
    keep(*results, given, attempt_of(runner, result, write_sequence(scan.samples, scan.recording.actions)));
  }
  if (!given.report.empty()) write_file(given.report, report_html(result, runner.trace()));
  std::fputs(to_json(result).c_str(), stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments(
      "Scores a recorded scan against a scenario and prints the result as JSON. A failed exam is a result too: the "
      "exit code is 0 for it, and 2 for input that cannot be used.",
      "insonate-score");
  arguments.footer(
      "Examples:\n"
      "  insonate-score --log scan.igs.mha --scenario exam.toml --report scan.html\n"
      "  insonate-score --log scan.igs.mha --scenario exam.toml --results lab.db --learner L-07\n"
      "  insonate-score attempts lab.db\n"
      "  insonate-score report lab.db --attempt 12 --out reports\n"
      "  insonate-score pass-mark lab.db --novices novices.csv --experts experts.csv\n"
      "  insonate-score check exam.toml");
  Arguments given;
  arguments.add_option("--log", given.log,
                       "The recorded scan: a PLUS/IGSIO sequence file (.igs.mha), or what --record-raw has written");
  arguments.add_option("--scenario", given.scenario, "The scenario, a TOML file");
  arguments.add_option("--case,--ct", given.case_folder,
                       "A case folder, CT file or DICOM folder to take instead of the scenario's own case");
  arguments.add_option("--transform", given.transform,
                       "The probe's transform in the log, as in replay:FILE?transform=...; else from Probe to "
                       "Patient, Reference or Tracker");
  arguments.add_option("--calibration", given.calibration,
                       "The tracker's calibration, where the log holds its sensor's poses and not the probe's");
  arguments.add_option("--seed", given.seed, "Draws the scenario's variant, as in the result of the live run (0)");
  arguments.add_option("--report", given.report, "Also writes a report as one HTML page");
  arguments.add_option("--results", given.results, "Also keeps the attempt in this database of results");
  arguments.add_option("--learner", given.learner, "Whose attempt it is: an opaque id")->capture_default_str();

  CommandRun run_command;
  add_check_command(arguments, run_command);
  add_list_commands(arguments, run_command);
  add_report_command(arguments, run_command);
  add_rescore_command(arguments, run_command);
  add_hand_in_command(arguments, run_command);
  add_pass_mark_command(arguments, run_command);

  return run_program(arguments, argc, argv, [&] {
    if (run_command) return run_command();
    if (given.log.empty()) throw CLI::RequiredError("--log");
    if (given.scenario.empty()) throw CLI::RequiredError("--scenario");
    return score(given);
  });
}
