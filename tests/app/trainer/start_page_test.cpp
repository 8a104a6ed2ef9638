#include "app/trainer/start_page.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <thread>

#include "app/trainer/folder_list.h"
#include "devices/sequence/sequence.h"
#include "scenarios/action.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

Options plain_options(const ResultsFolder& folder) {
  Options options;
  options.out = folder / "out";
  return options;
}

std::size_t index_of(const StartPage& page, const std::string& title) {
  const auto& offered = page.scenarios();
  const auto found =
      std::find_if(offered.begin(), offered.end(), [&](const OfferedScenario& one) { return one.title == title; });
  REQUIRE(found != offered.end());
  return std::size_t(found - offered.begin());
}

}  // namespace

TEST_CASE("the start page is shown where nothing says what to do, and somebody can choose") {
  CHECK(begins_on_start_page(Options()));
  const auto with = [](auto change) {
    Options options;
    change(options);
    return begins_on_start_page(options);
  };
  CHECK(with([](Options& o) { o.learner = "L-07"; }));
  CHECK_FALSE(with([](Options& o) { o.tracker = "mouse:"; }));
  CHECK_FALSE(with([](Options& o) { o.ct = "a.nii"; }));
  CHECK_FALSE(with([](Options& o) { o.case_folder = "a"; }));
  CHECK_FALSE(with([](Options& o) { o.scenario = "a.toml"; }));
  CHECK_FALSE(with([](Options& o) { o.mode_named = true; }));
  CHECK_FALSE(with([](Options& o) { o.headless = true; }));
  CHECK_FALSE(with([](Options& o) { o.seconds = 5; }));
  CHECK_FALSE(with([](Options& o) { o.screenshot = "a.png"; }));
}

TEST_CASE("each task of the start page turns into what the command line would say") {
  const ResultsFolder folder;
  StartPage page(plain_options(folder), nullptr);
  const auto chosen = [&](Task task) {
    page.task = task;
    REQUIRE(page.why_not() == "");
    return page.chosen();
  };
  REQUIRE(page.problem() == "");

  const Beginning demonstration = chosen(Task::demonstration);
  CHECK(demonstration.options.tracker.empty());
  CHECK(demonstration.options.scenario.empty());

  const Beginning lesson = chosen(Task::first_scan);
  CHECK(lesson.options.tracker == "mouse:");
  CHECK(lesson.guided);
  CHECK(is_bundled_patient({{}, {}, lesson.options.scenario, std::nullopt, 0}));  // it is there at once

  page.scenario = index_of(page, "Kidneys");
  REQUIRE(page.scenarios()[*page.scenario].variants.size() == 3);
  page.variant = 2;
  const Beginning practice = chosen(Task::practice);
  CHECK(practice.options.mode == Mode::practice);
  REQUIRE(practice.options.seed);
  CHECK(read_scenario(practice.options.scenario, *practice.options.seed).variant == "stone on the left");
  CHECK_FALSE(practice.free_practice);
  page.scenario.reset();
  CHECK(chosen(Task::practice).free_practice);
  CHECK(chosen(Task::practice).options.scenario.empty());

  page.task = Task::patients;
  page.add(assets_folder() / "logs" / "kidneys_poor.igs.mha");
  CHECK(page.task == Task::replay);
  const Beginning replay = chosen(Task::replay);
  CHECK(replay.options.mode == Mode::replay);
  CHECK(replay.options.replay.log == assets_folder() / "logs" / "kidneys_poor.igs.mha");
  CHECK(replay.options.replay.beside_log.empty());
  INFO("a recording does not name its scenario, so a person does");
  CHECK(replay.options.scenario.empty());
  page.run_scenario = index_of(page, "Kidneys");
  page.beside_expert = true;
  CHECK(chosen(Task::replay).options.scenario.filename() == "kidneys.toml");
  CHECK(chosen(Task::replay).options.replay.beside_log.filename() == "kidneys_good.igs.mha");

  write_file(folder / "water.mha", "ObjectType = Image");
  page.add(folder / "water.mha");
  const Beginning patient = chosen(Task::patients);
  CHECK(patient.options.ct == folder / "water.mha");
  CHECK(patient.free_practice);
  CHECK_THROWS_WITH(page.add(folder / "nothing.mha"), Catch::Contains("there is no such file"));
  const std::vector<std::filesystem::path> opened = page.opened_patients();
  REQUIRE(opened == std::vector{folder / "water.mha"});
  StartPage later(Options{}, nullptr);
  CHECK(later.opened_patients().empty());
  later.offer_again({folder / "gone.mha", opened.front(), folder / "exam.toml"}, CaseSource{});
  CHECK(later.opened_patients() == opened);
  CHECK(later.patients().back().name == "water.mha");
  CHECK(later.patient == 0);
  CaseSource chosen_before;
  chosen_before.ct = opened.front();
  later.offer_again(opened, chosen_before);
  CHECK(later.opened_patients() == opened);  // and not twice
  CHECK(later.patients()[later.patient].name == "water.mha");

  INFO("recordings are listed newest first, with their times, and before the bundled scans");
  const std::filesystem::path out = folder / "runs";
  const auto now = std::filesystem::file_time_type::clock::now();
  for (const char* name : {"a.igs.mha", "b.igs.mha", "c.igs.mha"}) write_file(out / name, "");
  std::filesystem::last_write_time(out / "b.igs.mha", now - std::chrono::hours(48));
  std::filesystem::last_write_time(out / "c.igs.mha", now + std::chrono::hours(1));
  Options with_runs;
  with_runs.out = out;
  const StartPage of_runs(with_runs, nullptr);
  REQUIRE(of_runs.runs().size() > 3);
  CHECK(of_runs.runs()[0].name == "c.igs.mha");
  CHECK(of_runs.runs()[1].name == "a.igs.mha");
  CHECK(of_runs.runs()[2].name == "b.igs.mha");
  CHECK(of_runs.runs()[2].about.find(time_text(changed_s(out / "b.igs.mha"))) == 0);

  INFO("a recording that names its patient is replayed on that patient");
  const auto replay_of = [&](const std::string& recorded) {
    std::vector<ProbeSample> samples(2);
    samples[1].time_s = 1;
    const ActionLog actions{{0.0, {Action{ActionKind::patient, {}, recorded}}}};
    write_file(folder / "run.igs.mha", write_sequence(samples, to_texts(actions)));
    page.add(folder / "run.igs.mha");
    page.run_scenario.reset();
    return chosen(Task::replay).options;
  };
  CHECK(replay_of("water.mha").ct == folder / "water.mha");
  CHECK(replay_of("water.mha").replay.without_steps);
  page.run_scenario = index_of(page, "Kidneys");
  const Options with_steps = chosen(Task::replay).options;
  CHECK(with_steps.ct == folder / "water.mha");
  CHECK(with_steps.scenario.filename() == "kidneys.toml");
  CHECK_FALSE(with_steps.replay.without_steps);
  CHECK(replay_of("nobody.mha").ct.empty());
  const OfferedScenario& aorta = page.scenarios()[index_of(page, "Aorta")];
  for (const OfferedVariant& each : aorta.variants) {
    const std::string changed = patient_words("Abdomen phantom", read_scenario(aorta.file, each.seed));
    const std::string of_page =
        patient_words("Abdomen phantom", read_scenario(replay_of(changed).scenario, *replay_of(changed).seed));
    CHECK(of_page == changed);
    page.run_scenario = index_of(page, "Aorta");
    CHECK(chosen(Task::replay).options.seed == each.seed);
  }
  page.run_scenario.reset();

  INFO("without a database there are no learners to look at");
  CHECK(page.tasks().size() == kTasks - 1);
  CHECK(page.tasks().back() == Task::setup);
  page.task = Task::setup;
  page.move_choice(+1);
  CHECK(page.task == Task::setup);
  page.move_choice(-1);
  CHECK(page.task == Task::replay);
  page.move_choice(-99);
  CHECK(page.task == Task::first_scan);

  page.task = Task::setup;
  CHECK(page.why_not().find("no sensor") != std::string::npos);
  page.choose_tracker(kRehearsal);
  CHECK(page.why_not() == "");
  page.task = Task::exam;
  CHECK(page.why_not().find("made-up hand takes no exam") != std::string::npos);
  page.task = Task::practice;
  page.scenario = 0;
  CHECK(page.why_not().find("choose Free practice") != std::string::npos);
  page.scenario.reset();
  CHECK(page.why_not() == "");
  page.task = Task::setup;
  page.choose_tracker("igtl://localhost/Probe");
  CHECK(page.trackers().front().checked);
  CHECK_FALSE(page.trackers().back().checked);  // nobody has asked the network
  CHECK(page.network_tracker() == "igtl://localhost/Probe");
  CHECK(tracker_uri_of("plus:18944") == "igtl://plus:18944");
  CHECK(tracker_uri_of("igtl://plus") == "igtl://plus");
  CHECK(tracker_uri_of("synthetic:7?live=1") == "synthetic:7?live=1");
  CHECK(tracker_uri_of("hydra:") == "hydra:");
  CHECK(tracker_uri_of("hydra:18944") == "igtl://hydra:18944");
  StartPage of_tomorrow(Options{}, nullptr);
  of_tomorrow.offer_network_tracker(page.network_tracker());
  CHECK(of_tomorrow.trackers().back().uri == "igtl://localhost/Probe");
  CHECK(of_tomorrow.tracker() == "mouse:");
  const Beginning setup = chosen(Task::setup);
  CHECK(setup.options.mode == Mode::setup);
  CHECK(setup.options.tracker == "igtl://localhost/Probe");
  CHECK(setup.options.landmarks.empty());
  const auto landmarks = assets_folder() / "calibration" / "abdomen.toml";
  page.choose_landmarks(landmarks);
  CHECK_THROWS_AS(page.choose_drawing(landmarks), InputError);
  CHECK_THROWS_AS(page.choose_landmarks(folder / "nothing.toml"), InputError);
  CHECK(page.chosen().options.landmarks == landmarks);
  CHECK(page.chosen().options.drawing.empty());
  CHECK_THROWS_AS(page.choose_tracker("igtl://?frame=x"), InputError);
  CHECK(page.tracker() == "igtl://localhost/Probe");
}

TEST_CASE("a recorded scan is offered beside the skilled scan of its exam") {
  const ResultsFolder folder;
  StartPage page(plain_options(folder), nullptr);
  page.task = Task::replay;
  page.beside_expert = true;
  const auto of = [&](const char* log) {
    const auto& runs = page.runs();
    const auto found =
        std::find_if(runs.begin(), runs.end(), [&](const OfferedRun& run) { return run.replay.log.filename() == log; });
    REQUIRE(found != runs.end());
    page.run = std::size_t(found - runs.begin());
    return page.chosen().options;
  };
  const Options poor = of("aorta_poor.igs.mha");
  CHECK(poor.scenario.filename() == "aorta.toml");
  CHECK(poor.replay.beside_log.filename() == "aorta_good.igs.mha");
  CHECK_FALSE(page.runs()[page.run].is_skilled);
  CHECK(of("aorta_good.igs.mha").replay.beside_log.empty());
  CHECK(page.runs()[page.run].is_skilled);
}

TEST_CASE("an exam needs a learner who has not taken it, and the page says so") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  Attempt taken = made_attempt("L-07", tiny_exam(0));
  taken.scenario_text = read_file(assets_folder() / "scenarios" / "knobs.toml");
  ExamResult result = result_from_json(taken.score_json, "attempt");
  result.provenance.mode = AttemptMode::exam;
  taken.score_json = to_json(result);
  database.add(taken);
  write_file(folder / "learners.csv", "learner\nL-08\n");

  Options options = plain_options(folder);
  StartPage page(options, &database);
  CHECK(page.problem() == "");
  CHECK(page.learners() == std::vector<std::string>{"L-07", "L-08"});
  page.task = Task::exam;
  page.scenario = index_of(page, "Knobs and orientation");
  CHECK(page.why_not().find("who is learning") != std::string::npos);
  page.choose_learner("L-07");
  CHECK(page.why_not().find("it is no. 1 of the results") != std::string::npos);
  CHECK(page.taken_in(page.scenarios()[*page.scenario]) == 1);
  CHECK(page.taken_in(page.scenarios()[index_of(page, "Aorta")]) == 0);
  CHECK(page.attempts().size() == 1);
  CHECK(page.tasks().back() == Task::learners);
  page.choose_learner("L-08");
  CHECK(page.why_not() == "");
  CHECK(page.taken_in(page.scenarios()[*page.scenario]) == 0);
  CHECK(page.attempts().empty());
  CHECK(page.chosen().options.mode == Mode::exam);
  CHECK(page.chosen().options.learner == "L-08");
  CHECK_FALSE(page.chosen().options.seed);  // drawn by chance
  CHECK_THROWS_AS(page.choose_learner("Ada Lovelace"), InputError);
  CHECK(page.learner() == "L-08");
  CHECK(page.refused_learner() == "Ada Lovelace");
  for (const Task task : {Task::first_scan, Task::practice, Task::exam, Task::patients}) {
    page.task = task;
    CHECK(page.why_not().find("'Ada Lovelace' is not an id") != std::string::npos);
  }
  page.task = Task::practice;
  page.choose_learner("L-08");
  CHECK(page.refused_learner().empty());
  CHECK(page.why_not() == "");

  INFO("the attempt can be looked at again");
  page.task = Task::replay;
  page.run = 0;
  CHECK(page.chosen().options.replay.attempt == 1);
  CHECK(page.chosen().options.results == folder / "results.db");

  Sitting begun;
  begun.learner = "L-08";
  begun.scenario_text = taken.scenario_text;
  begun.scenario_file = "knobs.toml";
  begun.title = "Knobs and orientation";
  database.begin(begun, "a part of its log");
  StartPage later(options, &database);
  later.task = Task::exam;
  later.scenario = index_of(later, "Knobs and orientation");
  later.choose_learner("L-08");
  CHECK(later.why_not().find("L-08 began this exam on ") == 0);
  CHECK(later.why_not().find("scored: insonate-score hand-in " + (folder / "results.db").string()) !=
        std::string::npos);
  later.scenario = index_of(later, "Aorta");
  CHECK(later.why_not() == "");
}

TEST_CASE("the person's own folder of cases is listed in place of the one before") {
  const ResultsFolder folder;
  for (const char* name : {"mine/liver", "other/spleen"}) write_file(folder / name / "case.toml", "format = 1\n");
  StartPage page(plain_options(folder), nullptr);
  const auto listed = [&](const std::string& name) {
    return std::count_if(page.patients().begin(), page.patients().end(),
                         [&](const OfferedPatient& offered) { return offered.name == name; });
  };
  const std::size_t built_in = page.patients().size();
  page.list_cases_in(folder / "mine");
  CHECK(listed("liver") == 1);  // its case.toml is incomplete
  write_file(folder / "mine/kidney/case.toml", "format = 1\nname = \"Patient 7\"\nct = \"ct.nrrd\"\n");
  page.list_cases_in(folder / "mine");
  CHECK(listed("Patient 7") == 1);
  page.list_cases_in(folder / "other");
  CHECK(listed("liver") == 0);
  CHECK(listed("spleen") == 1);
  CHECK_THROWS_AS(page.list_cases_in(folder / "nowhere"), InputError);
  page.list_cases_in({});
  CHECK(page.patients().size() == built_in);
}

TEST_CASE("another database is read into the page, and the learner and the tracker stay") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "lab.db");
  Attempt attempt = made_attempt("L-07", tiny_exam(0));
  database.add(attempt);
  StartPage page(plain_options(folder), nullptr);
  page.choose_learner("L-42");
  page.choose_tracker("igtl://localhost/Probe");
  CHECK(page.attempts().empty());
  page.read_again(folder / "out", &database);
  CHECK(page.database() == folder / "lab.db");
  CHECK(page.learners() == std::vector<std::string>{"L-07"});
  CHECK(page.learner() == "L-42");
  CHECK(page.tracker() == "igtl://localhost/Probe");
  page.task = Task::learners;
  page.read_again(folder / "out", nullptr);
  CHECK(page.database().empty());
  CHECK(page.task == Task::first_scan);
}

TEST_CASE("cases that come and go are listed while the page is shown, and the chosen patient stays chosen") {
  const ResultsFolder folder;
  std::filesystem::create_directories(folder / "mine" / "patient7");
  StartPage page(plain_options(folder), nullptr);
  page.list_cases_in(folder / "mine");
  const auto names = [&] {
    std::vector<std::string> listed;
    for (const OfferedPatient& patient : page.patients())
      if (!patient.listed_in.empty()) listed.push_back(patient.name);
    return listed;
  };
  CHECK(names().empty());
  page.patient = 1;
  const std::string chosen = page.patients()[1].name;
  // As insonate-case makes it: the folder first, and case.toml last.
  write_file(folder / "mine" / "patient7" / "case.toml", "");
  page.update(100);
  CHECK(names() == std::vector<std::string>{"patient7"});
  CHECK(page.patients()[page.patient].name == chosen);

  page.patient = page.patients().size() - 1;
  std::filesystem::create_directories(folder / "mine" / "patient3");
  write_file(folder / "mine" / "patient3" / "case.toml", "");
  page.update(101);  // too early to look again
  CHECK(names().size() == 1);
  const auto look = [&](double now_s) {
    // The search for trackers runs on a thread of its own, and the page looks for both.
    for (int wait = 0; wait < 1000 && names().size() == 1; ++wait) {
      page.update(now_s);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  };
  look(200);
  CHECK(names() == std::vector<std::string>{"patient3", "patient7"});
  CHECK(page.patients()[page.patient].name == "patient7");
}
