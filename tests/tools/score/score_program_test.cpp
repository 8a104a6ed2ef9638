// insonate-score LOG: what it prints, and what it refuses before it makes a patient.

#include "tests/tools/score/score_program.h"

#include <catch2/catch.hpp>

#include "devices/igtl/igtl_message.h"
#include "devices/replay/read_log.h"
#include "scenarios/result_json.h"
#include "scenarios/results/database/results_database.h"
#include "scenarios/results/trace_json.h"
#include "scenarios/runner.h"
#include "sim/files/digest.h"
#include "tests/devices/golden_reports.h"
#include "tests/devices/raw_text.h"

using namespace insonate;

TEST_CASE("insonate-score prints the very score that the trainer comes to, and a failed exam is a result") {
  const TemporaryFolder folder;
  const auto exam = folder.put("exam.toml", coarse_exam());
  const auto log = kAssets / "logs" / "ruq_poor.igs.mha";
  const auto report = folder.path / "report.html";
  const ProgramOutcome outcome =
      run_score("--log " + log.string() + " --scenario " + exam.string() + " --report " + report.string());
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.errors.empty());

  const Scenario scenario = read_scenario(exam);
  const Case subject = load_case(scenario, kAssets, cache_folder());
  Runner runner(scenario, subject, read_tissue_table(kAssets / "tissues.toml"));
  for (const ProbeSample& sample : read_recorded_scan(log).samples) runner.feed(sample);
  runner.end();
  ExamResult expected = runner.result();
  expected.provenance.mode = AttemptMode::recording;
  expected.provenance.log = "ruq_poor.igs.mha";
  expected.provenance.log_digest = digest_of(read_file(log));
  expected.provenance.log_transform = "ProbeToTracker, TrackerToPatient";
  CHECK(outcome.output == to_json(expected));
  CHECK_FALSE(result_from_json(outcome.output, "output").passed);
  CHECK(read_file(report).find("Not passed") != std::string::npos);
}

TEST_CASE("insonate-score scores what a tracker's device sent as the log of its samples") {
  const TemporaryFolder folder;
  const auto exam = folder.put("exam.toml", coarse_exam());
  const std::vector<ProbeSample> log = read_recorded_scan(kAssets / "logs" / "ruq_good.igs.mha").samples;
  std::string raw = raw_igtl_head("igtl://lab?filter=off", log.front().time_s);
  for (const ProbeSample& sample : log) {
    const bool ok = sample.status == PoseStatus::ok;
    raw += (ok ? "read " : "silent ") + shortest(sample.time_s);
    raw += ok ? " " + hex(igtl::make_transform("Probe", 0, sample.patient_from_probe)) + "\n" : "\n";
  }
  const std::string file = folder.put("run.raw", raw).string(), to = " --scenario " + exam.string();
  const std::string same = folder.put("same.igs.mha", write_sequence(read_log(file).samples)).string();
  const ProgramOutcome of_log = run_score("--log " + same + to);
  REQUIRE(of_log.code == 0);
  ExamResult expected = result_from_json(of_log.output, "output");
  expected.provenance.log = "run.raw";
  expected.provenance.log_digest = digest_of(raw);
  expected.provenance.log_transform = "reports of igtl://lab?filter=off";
  for (const char* as : {"", "raw:"}) CHECK(run_score("--log " + (as + file) + to).output == to_json(expected));

  const auto sensor = folder.put("sensor.raw",
                                 "insonate raw 1\ntracker hydra:?raw=1\nstart 1 0 0 0 1 0 0 0 1 0 0 0\n"
                                 "open 1 1532:0300\nread 2 " +
                                     hex(golden::kHydra) + "\n");
  const ProgramOutcome refused = run_score("--log " + sensor.string() + to);
  CHECK(refused.code == 2);
  CHECK(refused.errors.find("--calibration") != std::string::npos);
}

TEST_CASE("insonate-score says in one sentence what is wrong with its input, and exits with 2") {
  const TemporaryFolder folder;
  const std::string log = (kAssets / "logs" / "ruq_good.igs.mha").string();
  const std::string exam = (kAssets / "scenarios" / "ruq_hepatorenal.toml").string();
  const std::string misspelt = folder.put("misspelt.toml", "format = 1\ntittle = \"x\"\n").string();
  const std::string elsewhere =
      folder
          .put("elsewhere.toml",
               [] {
                 std::string text = coarse_exam();
                 text.replace(text.find("view = \"hepatorenal\""), 20, "view = \"hepatorenl\"");
                 return text;
               }())
          .string();
  const std::string cut = folder.put("cut.igs.mha", read_file(log).substr(0, 5000)).string();

  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const ProgramOutcome outcome = run_score(arguments);
    INFO(arguments << "\n" << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.output.empty());
    CHECK(outcome.errors.find(words) != std::string::npos);
  };
  refused("--scenario " + exam, "--log");
  refused("--log " + log, "--scenario");
  refused("--log /nowhere.mha --scenario " + exam, "/nowhere.mha");
  refused("--log " + exam + " --scenario " + exam, "ruq_hepatorenal.toml");
  refused("--log " + cut + " --scenario " + exam, "cut.igs.mha");
  refused("--log " + log + " --scenario " + misspelt, "did you mean 'title'?");
  refused("--log " + log + " --scenario " + exam + " --case /nowhere", "/nowhere");
  refused("--log " + log + " --scenario " + exam + " --cse x", "--cse");
  refused("check " + misspelt, "the key 'case' is missing");
  refused("check " + elsewhere,
          "step 2 names the view 'hepatorenl', which the case 'Abdomen phantom' does not have; did you mean "
          "'hepatorenal'?");
}

TEST_CASE("insonate-score makes no patient for what it refuses without one") {
  const TemporaryFolder folder;
  const auto cache = folder.path / "cache";
  const auto run_here = [&](const std::string& arguments) {
    return run_program("XDG_CACHE_HOME=" + cache.string() + " " INSONATE_SCORE_PROGRAM " " + arguments);
  };
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const ProgramOutcome outcome = run_here(arguments);
    INFO(arguments << "\n" << outcome.output << outcome.errors);
    CHECK(outcome.code != 0);
    CHECK((outcome.output + outcome.errors).find(words) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(cache));
  };
  const std::string exam = coarse_exam(), exam_file = folder.put("exam.toml", exam).string();
  const auto spoilt = [&](const char* name, const std::string& from, const std::string& to) {
    std::string text = exam;
    replace_first(text, from, to);
    return folder.put(name, text).string();
  };
  refused("check " + folder.put("cut.toml", exam.substr(0, exam.find("title") + 8)).string(), "this is not TOML");
  refused("check " + folder.put("short.toml", exam.substr(0, exam.find("[[step]]"))).string(), "there are no steps");
  refused("check " + spoilt("newer.toml", "format = ", "format = 9"), "format 9");
  refused("check " + spoilt("gone.toml", "case = \"abdomen\"", "case = \"gone\""), "is not a folder beside the file");

  const std::string log = read_file(kAssets / "logs" / "ruq_good.igs.mha");
  const auto score = [&](const std::string& log_file) { return "--log " + log_file + " --scenario " + exam_file; };
  const std::string good = folder.put("good.igs.mha", log).string();
  std::string acts = log;
  replace_first(acts, "Seq_Frame0001_FrameNumber", "Seq_Frame0001_Actions = dance\nSeq_Frame0001_FrameNumber");
  refused(score(folder.put("cut.igs.mha", log.substr(0, 5000)).string()), "cut.igs.mha");
  refused(score(folder.put("acts.igs.mha", acts).string()), "dance");
  refused(score(good) + " --results " + folder.put("text.db", "no database").string(), "not a database of results");
  refused(score(good) + " --calibration " + folder.put("bad.toml", "x").string(), "bad.toml");
  refused("--log " + good + " --scenario " + spoilt("typo.toml", "title", "tittle"), "did you mean 'title'?");

  const std::string database = (folder.path / "lab.db").string();
  ResultsDatabase opened = ResultsDatabase::open_or_make(database);
  Attempt attempt;
  attempt.learner = "L-01";
  attempt.scenario_text = exam;
  attempt.score_json = to_json(ExamResult());
  attempt.trace_json = to_json(std::vector<TracePoint>());
  attempt.log = "no sequence";
  opened.add(attempt);
  refused("rescore " + database, "it cannot be scored");
  Sitting sitting;
  sitting.learner = "L-02";
  sitting.scenario_text = exam;
  opened.begin(sitting, "no sequence");
  sqlite::Connection(database, false).run("UPDATE sitting_part SET kept_ms = 0");
  refused("hand-in " + database, ": sitting 1: ");

  INFO("what is right does make one");
  CHECK(run_here("check " + exam_file).code == 0);
  CHECK(std::filesystem::exists(cache / "insonate" / "phantoms"));
}
