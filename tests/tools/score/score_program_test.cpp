#include <catch2/catch.hpp>
#include <sys/wait.h>

#include <cstdlib>

#include "devices/igtl/igtl_message.h"
#include "devices/replay/read_log.h"
#include "scenarios/result_json.h"
#include "scenarios/results/results_database.h"
#include "scenarios/results/trace_json.h"
#include "scenarios/runner.h"
#include "sim/core/digest.h"
#include "sim/core/files.h"
#include "tests/devices/golden_reports.h"
#include "tests/devices/raw_text.h"

using namespace insonate;

namespace {

const std::filesystem::path kAssets = INSONATE_ASSETS_FOLDER;

struct Outcome {
  int code;
  std::string output;
  std::string errors;
};

/// A folder of its own for files, gone at the end.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("insonate_score_" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path file(const char* name, const std::string& text) const {
    write_file(path / name, text);
    return path / name;
  }
};

std::string text_of(const std::filesystem::path& file) {
  return std::filesystem::file_size(file) > 0 ? read_file(file) : "";
}

Outcome run_command(const Folder& folder, const std::string& command) {
  const auto output = folder.path / "output";
  const auto errors = folder.path / "errors";
  const int status = std::system((command + " >" + output.string() + " 2>" + errors.string()).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(output), text_of(errors)};
}

Outcome run(const Folder& folder, const std::string& arguments) {
  return run_command(folder, INSONATE_SCORE_PROGRAM + (" " + arguments));
}

/// The bundled exam on a phantom that is made in seconds.
std::string coarse_exam() {
  std::string text = read_file(kAssets / "scenarios" / "ruq_hepatorenal.toml");
  const std::string key = "free_fluid = true\n";
  return text.insert(text.find(key) + key.size(), "voxel_mm = 2\n");
}

void replace_first(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("insonate-score prints the very score that the trainer comes to, and a failed exam is a result") {
  const Folder folder;
  const auto exam = folder.file("exam.toml", coarse_exam());
  const auto log = kAssets / "logs" / "ruq_poor.igs.mha";
  const auto report = folder.path / "report.html";
  const Outcome outcome =
      run(folder, "--log " + log.string() + " --scenario " + exam.string() + " --report " + report.string());
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
  const Folder folder;
  const auto exam = folder.file("exam.toml", coarse_exam());
  const std::vector<ProbeSample> log = read_recorded_scan(kAssets / "logs" / "ruq_good.igs.mha").samples;
  std::string raw = raw_igtl_head("igtl://lab?filter=off", log.front().time_s);
  for (const ProbeSample& sample : log) {
    const bool ok = sample.status == PoseStatus::ok;
    raw += (ok ? "read " : "silent ") + shortest(sample.time_s);
    raw += ok ? " " + hex(igtl::make_transform("Probe", 0, sample.patient_from_probe)) + "\n" : "\n";
  }
  const std::string file = folder.file("run.raw", raw).string(), to = " --scenario " + exam.string();
  const std::string same = folder.file("same.igs.mha", write_sequence(read_log(file).samples)).string();
  const Outcome of_log = run(folder, "--log " + same + to);
  REQUIRE(of_log.code == 0);
  ExamResult expected = result_from_json(of_log.output, "output");
  expected.provenance.log = "run.raw";
  expected.provenance.log_digest = digest_of(raw);
  expected.provenance.log_transform = "reports of igtl://lab?filter=off";
  for (const char* as : {"", "raw:"}) CHECK(run(folder, "--log " + (as + file) + to).output == to_json(expected));

  const auto sensor = folder.file("sensor.raw",
                                  "insonate raw 1\ntracker hydra:?raw=1\nstart 1 0 0 0 1 0 0 0 1 0 0 0\n"
                                  "open 1 1532:0300\nread 2 " +
                                      hex(golden::kHydra) + "\n");
  const Outcome refused = run(folder, "--log " + sensor.string() + to);
  CHECK(refused.code == 2);
  CHECK(refused.errors.find("--calibration") != std::string::npos);
}

TEST_CASE("insonate-score says in one sentence what is wrong with its input, and exits with 2") {
  const Folder folder;
  const std::string log = (kAssets / "logs" / "ruq_good.igs.mha").string();
  const std::string exam = (kAssets / "scenarios" / "ruq_hepatorenal.toml").string();
  const std::string misspelt = folder.file("misspelt.toml", "format = 1\ntittle = \"x\"\n").string();
  const std::string elsewhere =
      folder
          .file("elsewhere.toml",
                [] {
                  std::string text = coarse_exam();
                  text.replace(text.find("view = \"hepatorenal\""), 20, "view = \"hepatorenl\"");
                  return text;
                }())
          .string();
  const std::string cut = folder.file("cut.igs.mha", read_file(log).substr(0, 5000)).string();

  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = run(folder, arguments);
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

TEST_CASE("insonate-score check passes the bundled exam") {
  const Folder folder;
  const Outcome outcome = run(folder, "check " + folder.file("exam.toml", coarse_exam()).string());
  INFO(outcome.errors);
  CHECK(outcome.code == 0);
  CHECK(outcome.output.find("no problems found") != std::string::npos);
}

TEST_CASE("insonate-score check tells of a scenario's text and then of its case") {
  const Folder folder;
  std::string exam = coarse_exam();
  const auto spoil = [&](const std::string& from, const std::string& to) { replace_first(exam, from, to); };
  spoil("view = \"hepatorenal\"", "view = \"hepatorenl\"");
  spoil("pass_mark_percent", "pass_mark");
  const std::string file = folder.file("exam.toml", exam).string();
  const Outcome outcome = run(folder, "check " + file);
  INFO(outcome.errors);
  CHECK(outcome.code == 2);
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 2);
  CHECK(outcome.errors.find("'pass_mark'") < outcome.errors.find("did you mean 'hepatorenal'?"));
  CHECK(outcome.errors.find("did you mean 'hepatorenal'?") != std::string::npos);

  INFO("of a step of no kind there is still the view to look at");
  spoil("kind = \"find_view\"", "kind = \"find_vew\"");
  const Outcome unknown = run(folder, "check " + folder.file("kind.toml", exam).string());
  CHECK(unknown.code == 2);
  CHECK(unknown.errors.find("2 problems") != std::string::npos);
  CHECK(unknown.errors.find("did you mean 'hepatorenal'?") != std::string::npos);
  CHECK(unknown.errors.find("marks nothing") == std::string::npos);
  const Outcome text = run(folder, "check --without-case " + file);
  CHECK(text.code == 2);
  CHECK(text.errors.find("hepatorenl") == std::string::npos);
}

TEST_CASE("insonate-score check tells what is wrong with every variant and its patient, each where it stands") {
  const Folder folder;
  std::string exam = coarse_exam();
  const auto spoil = [&](const std::string& from, const std::string& to) { replace_first(exam, from, to); };
  spoil("view = \"hepatorenal\"", "view = \"${view}\"");
  spoil("[phantom] ",
        "[[variant]]\nname = \"one\"\nphantom = { fre_fluid = true }\nwords = { view = \"hepatorenl\" }\n\n"
        "[[variant]]\nname = \"two\"\nphantom = { aorta_diameter_mm = 900 }\nwords = { view = \"liver_lng\" }\n\n"
        "[[variant]]\nname = \"three\"\ncase = \"gone\"\nwords = { view = \"hepatorenal\" }\n\n[phantom] ");
  spoil("metric = \"plane_angle_deg\"", "metric = \"plane_angel_deg\"");
  const Outcome outcome = run(folder, "check " + folder.file("exam.toml", exam).string());
  INFO(outcome.errors);
  CHECK(outcome.code == 2);
  const auto line_of = [&](const std::string& text) {
    return "line " + std::to_string(1 + std::count(exam.begin(), exam.begin() + long(exam.find(text)), '\n')) + ",";
  };
  const auto told = [&](const std::string& at, const std::string& words) {
    INFO(words);
    const std::size_t found = outcome.errors.find(words);
    REQUIRE(found != std::string::npos);
    const std::size_t line = outcome.errors.rfind("line ", found);
    CHECK(outcome.errors.substr(line, line_of(at).size()) == line_of(at));
  };
  told("fre_fluid", "the phantom's option 'fre_fluid': the recipe has no such option; did you mean 'free_fluid'?");
  told("900", "the phantom's option 'aorta_diameter_mm': '900' is out of range");
  told("\"gone\"", "the case 'gone' is not a folder beside the file");
  told("${view}", "the view 'hepatorenl'");
  told("${view}", "the view 'liver_lng'");
  told("plane_angel_deg", "did you mean 'plane_angle_deg'?");
  CHECK(outcome.errors.find("'hepatorenal', which") == std::string::npos);
}

TEST_CASE("insonate-score check tells of the text first, then of each patient, with progress on a terminal alone") {
  const Folder folder;
  std::string exam = coarse_exam();
  replace_first(exam, "view = \"hepatorenal\"", "view = \"${view}\"");
  replace_first(exam, "pass_mark_percent", "pass_mark");
  replace_first(exam, "[phantom] ",
                "[[variant]]\nname = \"one\"\nwords = { view = \"hepatorenal\" }\n\n"
                "[[variant]]\nname = \"two\"\nwords = { view = \"hepatorenl\" }\n\n[phantom] ");
  const std::string file = folder.file("exam.toml", exam).string();
  const Outcome seen =
      run_command(folder, "script -qefc '" INSONATE_SCORE_PROGRAM " check " + file + "' /dev/null </dev/null");
  INFO(seen.output);
  CHECK(seen.code == 2);
  std::size_t before = 0;
  for (const char* next :
       {"'pass_mark'", "variant 1 of 2, one: ", "variant 2 of 2, two: ", " s left", "'hepatorenl'"}) {
    const std::size_t at = seen.output.find(next, before);
    INFO(next);
    REQUIRE(at != std::string::npos);
    before = at;
  }

  const Outcome piped = run(folder, "check " + file);
  CHECK(piped.code == 2);
  CHECK(piped.output.empty());
  CHECK(std::count(piped.errors.begin(), piped.errors.end(), '\n') == 2);
  CHECK(piped.errors.find("'hepatorenl'") != std::string::npos);
  CHECK(piped.errors.find("variant 1 of") == std::string::npos);
  CHECK(piped.errors.find('\r') == std::string::npos);
}

TEST_CASE("insonate-score makes no patient for what it refuses without one") {
  const Folder folder;
  const auto cache = folder.path / "cache";
  const auto run_here = [&](const std::string& arguments) {
    return run_command(folder, "XDG_CACHE_HOME=" + cache.string() + " " INSONATE_SCORE_PROGRAM " " + arguments);
  };
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = run_here(arguments);
    INFO(arguments << "\n" << outcome.output << outcome.errors);
    CHECK(outcome.code != 0);
    CHECK((outcome.output + outcome.errors).find(words) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(cache));
  };
  const std::string exam = coarse_exam(), exam_file = folder.file("exam.toml", exam).string();
  const auto spoilt = [&](const char* name, const std::string& from, const std::string& to) {
    std::string text = exam;
    replace_first(text, from, to);
    return folder.file(name, text).string();
  };
  refused("check " + folder.file("cut.toml", exam.substr(0, exam.find("title") + 8)).string(), "this is not TOML");
  refused("check " + folder.file("short.toml", exam.substr(0, exam.find("[[step]]"))).string(), "there are no steps");
  refused("check " + spoilt("newer.toml", "format = ", "format = 9"), "format 9");
  refused("check " + spoilt("gone.toml", "case = \"abdomen\"", "case = \"gone\""), "is not a folder beside the file");

  const std::string log = read_file(kAssets / "logs" / "ruq_good.igs.mha");
  const auto score = [&](const std::string& log_file) { return "--log " + log_file + " --scenario " + exam_file; };
  const std::string good = folder.file("good.igs.mha", log).string();
  std::string acts = log;
  replace_first(acts, "Seq_Frame0001_FrameNumber", "Seq_Frame0001_Actions = dance\nSeq_Frame0001_FrameNumber");
  refused(score(folder.file("cut.igs.mha", log.substr(0, 5000)).string()), "cut.igs.mha");
  refused(score(folder.file("acts.igs.mha", acts).string()), "dance");
  refused(score(good) + " --results " + folder.file("text.db", "no database").string(), "not a database of results");
  refused(score(good) + " --calibration " + folder.file("bad.toml", "x").string(), "bad.toml");
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

TEST_CASE(
    "insonate-score keeps attempts, lists them, scores them again to the same bits, and makes their reports again") {
  const Folder folder;
  const auto exam = folder.file("exam.toml", coarse_exam());
  const std::string database = (folder.path / "lab.db").string();
  std::string scores[2];
  for (const char* scan : {"good", "poor"}) {
    const auto log = kAssets / "logs" / ("ruq_" + std::string(scan) + ".igs.mha");
    const Outcome outcome = run(folder, "--log " + log.string() + " --scenario " + exam.string() + " --results " +
                                            database + " --learner L-" + scan);
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
    scores[scan == std::string("poor")] = outcome.output;
  }

  const std::string attempts = run(folder, "attempts " + database).output;
  CHECK(attempts.find("L-good") < attempts.find("L-poor"));
  CHECK(attempts.find(" passed ") < attempts.find("not passed"));
  CHECK(run(folder, "attempts " + database + " --learner L-poor").output.find("L-good") == std::string::npos);
  CHECK(attempts.find(" recording ") != std::string::npos);
  CHECK(run(folder, "attempts " + database + " --mode exam").output.find("L-") == std::string::npos);
  CHECK(run(folder, "learners " + database).output.find("L-poor") != std::string::npos);

  const Outcome again = run(folder, "rescore " + database);
  INFO(again.output << again.errors);
  CHECK(again.code == 0);
  CHECK(again.output == "attempt 1: the same\nattempt 2: the same\n2 the same, 0 not\n");

  REQUIRE(run(folder, "report " + database + " --attempt 2 --out " + folder.path.string()).code == 0);
  CHECK(read_file(folder.path / "attempt-2" / "score.json") == scores[1]);
  CHECK(read_file(folder.path / "attempt-2" / "report.html").find("L-poor") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path / "attempt-1"));

  // Another case in its place: the same scenario text, but the folder it names has gone.
  ResultsDatabase opened = ResultsDatabase::open(database);
  Attempt moved = opened.read(1);
  moved.patient = (folder.path / "gone").string();
  opened.add(moved);
  Attempt other = opened.read(1);
  const std::string points = "\"passed\": true";
  other.score_json.replace(other.score_json.find(points), points.size(), "\"passed\": false");
  opened.add(other);
  const Outcome different = run(folder, "rescore " + database);
  CHECK(different.code == 1);
  CHECK(different.output.find("attempt 3: it cannot be scored: ") != std::string::npos);
  CHECK(different.output.find("attempt 4: passed: false then, true now\n") != std::string::npos);
}

TEST_CASE("insonate-score makes the other reports when an attempt is damaged") {
  const Folder folder;
  const std::string database = (folder.path / "lab.db").string();
  for (int i = 0; i < 3; ++i) {
    Attempt attempt;
    attempt.learner = "L-01";
    attempt.score_json = to_json(ExamResult());
    attempt.trace_json = to_json(std::vector<TracePoint>());
    ResultsDatabase::open_or_make(database).add(attempt);
  }
  sqlite::Connection(database, false).run("UPDATE attempt SET log_digest = 'x' WHERE number = 2");
  const Outcome outcome = run(folder, "report " + database + " --out " + (folder.path / "reports").string());
  INFO(outcome.errors);
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("attempt 2: its log is damaged") != std::string::npos);
  for (const int number : {1, 2, 3})
    CHECK(std::filesystem::exists(folder.path / ("reports/attempt-" + std::to_string(number)) / "report.html") ==
          (number != 2));
  sqlite::Connection(database, false).run("UPDATE attempt SET score = '{' WHERE number = 3");
  const Outcome without_score = run(folder, "report " + database + " --out " + (folder.path / "again").string());
  INFO(without_score.errors);
  CHECK(without_score.errors.find("lab.db: attempt 3: this is not a result of Insonate: line 1 is not JSON; score") !=
        std::string::npos);
}

TEST_CASE("insonate-score stores comments, lists and reports them, removes them, and writes all tables") {
  const Folder folder;
  const std::string database = (folder.path / "lab.db").string();
  for (const auto& [learner, mode] : {std::pair{"L-01", AttemptMode::exam}, {"L-02", AttemptMode::practice}}) {
    ExamResult result;
    result.provenance.mode = mode;
    Attempt attempt;
    attempt.learner = learner;
    attempt.score_json = to_json(result);
    attempt.trace_json = to_json(std::vector<TracePoint>());
    ResultsDatabase::open_or_make(database).add(attempt);
  }
  const Outcome made = run(folder, "comment " + database + " --attempt 1 --author T-02 --text 'Slow down & hold'");
  INFO(made.errors);
  CHECK(made.code == 0);
  CHECK(made.output == "comment 1 on attempt 1\n");
  CHECK(run(folder, "comment " + database + " --attempt 2 --text 'Well held'").code == 0);

  const std::string attempts = run(folder, "attempts " + database).output;
  const std::size_t listed = attempts.find("\ncomment 1 on attempt 1 by T-02, 20");
  REQUIRE(listed != std::string::npos);
  CHECK(attempts.find("Z: Slow down & hold\n", listed) != std::string::npos);
  CHECK(attempts.find("\ncomment 2 on attempt 2, 20") != std::string::npos);
  CHECK(run(folder, "attempts " + database + " --learner L-01").output.find("comment 2") == std::string::npos);
  CHECK(run(folder, "attempts " + database + " --mode practice").output.find("comment 1 ") == std::string::npos);

  REQUIRE(run(folder, "report " + database + " --attempt 1 --out " + folder.path.string()).code == 0);
  CHECK(read_file(folder.path / "attempt-1/report.html").find("Slow down &amp; hold<small>T-02, ") !=
        std::string::npos);

  const std::string tables = (folder.path / "tables").string();
  const Outcome exported = run(folder, "export " + database + " --out " + tables);
  INFO(exported.errors);
  CHECK(exported.code == 0);
  CHECK(exported.output == "wrote " + tables + "/learners.csv\nwrote " + tables + "/attempts.csv\nwrote " + tables +
                               "/scores.csv\nwrote " + tables + "/comments.csv\n");
  CHECK(read_file(folder.path / "tables/comments.csv").find("\"T-02\"") != std::string::npos);

  CHECK(run(folder, "comment " + database + " --remove 1").output == "comment 1 is removed\n");
  CHECK(run(folder, "attempts " + database).output.find("comment 1 ") == std::string::npos);
  CHECK(run(folder, "attempts " + database).output.find("comment 2 ") != std::string::npos);

  INFO("an attempt that is damaged leaves the tables of the others");
  sqlite::Connection(database, false).run("UPDATE attempt SET score = '{}' WHERE number = 1");
  const Outcome partly = run(folder, "export " + database + " --out " + tables + "2");
  CHECK(partly.code == 2);
  CHECK(partly.errors.find("attempt 1: ") != std::string::npos);
  CHECK(std::filesystem::exists(tables + "2/attempts.csv"));
}

TEST_CASE("insonate-score sets a pass mark from two lists of learners") {
  const Folder folder;
  const std::string database = (folder.path / "lab.db").string();
  ResultsDatabase opened = ResultsDatabase::open_or_make(database);
  const auto add = [&](const char* learner, double percent, const char* scenario = "exam",
                       AttemptMode mode = AttemptMode::exam) {
    ExamResult result;
    result.provenance.mode = mode;
    result.complete = true;
    result.percent = percent;
    Attempt attempt;
    attempt.learner = learner;
    attempt.scenario_text = scenario;
    attempt.score_json = to_json(result);
    opened.add(attempt);
  };
  // Means 40 and 80, equal deviations; neither practice nor the second attempt of a novice counts.
  add("n1", 90, "exam", AttemptMode::practice);
  for (const auto& [learner, percent] : {std::pair{"n1", 10.0},
                                         {"n2", 40.0},
                                         {"n3", 70.0},
                                         {"e1", 50.0},
                                         {"e2", 80.0},
                                         {"e3", 110.0},
                                         {"n1", 100.0},
                                         {"other", 5.0}})
    add(learner, percent);
  const std::string lists = " --novices " + folder.file("n.csv", "learner\nn1\nn2\nn3\nn4\n").string() + " --experts " +
                            folder.file("e.toml", "format = 1\nlearners = [\"e1\", \"e2\", \"e3\"]\n").string();
  const Outcome outcome = run(folder, "pass-mark " + database + lists);
  INFO(outcome.errors);
  CHECK(outcome.code == 0);
  CHECK(outcome.output.find("pass mark: 60.00 %\nnovices: 3 of 4 took it, mean 40.00 %") == 0);
  CHECK(outcome.output.find("false passes: 33.3 % observed, 25.2 % by the normal") != std::string::npos);

  const Outcome practice = run(folder, "pass-mark " + database + lists + " --mode practice");
  CHECK(practice.code == 2);
  CHECK(practice.errors.find("fewer than two scores of novices") != std::string::npos);

  add("n4", 20, "another exam");
  const Outcome several = run(folder, "pass-mark " + database + lists);
  CHECK(several.code == 2);
  CHECK(several.errors.find("2 different scenarios") != std::string::npos);
  CHECK(run(folder, "pass-mark " + database + lists + " --scenario " + folder.file("exam.toml", "exam").string())
            .output == outcome.output);
}

TEST_CASE("insonate-score refuses databases and lists that it cannot use in one sentence") {
  const Folder folder;
  const std::string text = folder.file("text.db", "no database").string();
  const std::string ids = folder.file("ids.csv", "learner\na\n").string();
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = run(folder, arguments);
    INFO(arguments << "\n" << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.errors.find(words) != std::string::npos);
    CHECK(outcome.errors.find('\n') == outcome.errors.size() - 1);
  };
  for (const char* command : {"attempts ", "learners ", "rescore ", "report "}) {
    refused(command + text, "not a database of results");
    refused(command + (folder.path / "none.db").string(), "no such file");
  }
  refused("pass-mark " + text + " --novices " + ids + " --experts " + ids, "'a' is a novice as well");
  refused("--log x --scenario y --learner 'Ada Lovelace'", "not an opaque id");
  ResultsDatabase::open_or_make(folder.path / "lab.db");
  refused("report " + (folder.path / "lab.db").string() + " --attempt 3", "no attempt 3");
  const std::string lab = (folder.path / "lab.db").string();
  refused("report " + lab + " --home-page lab", "not a web address");
  refused("comment " + lab, "--attempt or --remove is required");
  refused("comment " + lab + " --attempt 3", "--text is required");
  refused("comment " + lab + " --attempt 3 --text x", "no attempt 3");
  refused("comment " + lab + " --attempt 3 --text \"$(printf 'two\\nlines')\"",
          "command line: comment: character 4 of the comment is a line break; write one paragraph");
  refused("comment " + lab + " --attempt 3 --text x --author 'Ada Lovelace'", "not an opaque id");
  refused("comment " + lab + " --remove 3", "no comment 3");
  refused("comment " + lab + " --remove 3 --text x", "excludes");
  refused("comment " + text + " --attempt 3 --text x", "not a database of results");
  refused("export " + lab, "--out is required");
  refused("export " + lab + " --out " + text, "name a folder that is new");
  refused("export " + text + " --out " + (folder.path / "tables").string(), "not a database of results");
}
