#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "devices/calibrated_tracker.h"
#include "devices/replay/read_log.h"
#include "scenarios/report/report.h"
#include "scenarios/result_json.h"
#include "scenarios/results/database/results_database.h"
#include "scenarios/results/learner_id.h"
#include "scenarios/runner.h"
#include "scenarios/scenario.h"
#include "sim/files/files.h"
#include "sim/tissue/tissue.h"
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
      "Score a recorded scan against a scenario and print the result as JSON. A failed exam is a result too: its exit "
      "code is 0. The exit code is 2 for input that cannot be used.",
      "insonate-score");
  arguments.footer(
      "Examples:\n"
      "  insonate-score --log scan.igs.mha --scenario exam.toml --report scan.html\n"
      "  insonate-score --log scan.igs.mha --scenario exam.toml --results lab.db --learner L-07\n"
      "  insonate-score attempts lab.db\n"
      "  insonate-score report lab.db --attempt 12 --out reports\n"
      "  insonate-score comment lab.db --attempt 12 --text \"Slow down over the ribs\"\n"
      "  insonate-score export lab.db --out tables\n"
      "  insonate-score pass-mark lab.db --novices novices.csv --experts experts.csv\n"
      "  insonate-score check exam.toml");
  Arguments given;
  arguments
      .add_option(
          "--log", given.log,
          "Score this recorded scan: a PLUS/IGSIO sequence file (.igs.mha), or a file that --record-raw has written")
      ->type_name("FILE");
  arguments.add_option("--scenario", given.scenario, "Score it against this scenario file (TOML)")->type_name("FILE");
  arguments
      .add_option("--case,--ct", given.case_folder, "Take the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the scenario's patient");
  arguments
      .add_option("--transform", given.transform,
                  "Take the probe's poses from this transform of the log, such as ProbeToTracker")
      ->type_name("NAME")
      ->default_str("the one from Probe to Patient, Reference or Tracker");
  arguments
      .add_option("--calibration", given.calibration,
                  "Use this calibration of the tracker, if the log has poses of its sensor instead of the probe")
      ->type_name("FILE");
  arguments
      .add_option("--seed", given.seed,
                  "Draw the scenario's variant with this seed, which the result of the live run states")
      ->capture_default_str();
  arguments.add_option("--report", given.report, "Write a report too, as one HTML page")->type_name("FILE");
  arguments.add_option("--results", given.results, "Store the attempt in this database of results too")
      ->type_name("FILE");
  arguments.add_option("--learner", given.learner, "Store the attempt under this learner's id, which is not a name")
      ->type_name("ID")
      ->capture_default_str();

  CommandRun run_command;
  add_check_command(arguments, run_command);
  add_list_commands(arguments, run_command);
  add_report_command(arguments, run_command);
  add_comment_command(arguments, run_command);
  add_export_command(arguments, run_command);
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
