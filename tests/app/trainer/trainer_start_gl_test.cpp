#include <catch2/catch.hpp>

#include <chrono>
#include <thread>

#include "app/trainer/trainer.h"
#include "tests/app/trainer/trainer_folder.h"
#include "tests/gl/test_context.h"

using namespace insonate;

namespace {

/// The built-in patient is prepared behind the page. Nothing may be destroyed while that is given up.
struct Patience {
  ~Patience() {
    while (Loading::given_up() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
};

void begin(Trainer& trainer) {
  REQUIRE(trainer.start_page());
  REQUIRE(trainer.start_page()->why_not() == "");
  trainer.begin_chosen();
  trainer.finish_loading();
}

}  // namespace

TEST_CASE("the start page begins what is chosen, and is there again afterwards") {
  const Patience patience;
  const test::TestContext context;
  const TrainerFolder folder;
  Options options;
  options.out = folder.path / "out";
  Trainer trainer(options);
  trainer.open_from_options();
  CHECK_FALSE(trainer.loading());
  CHECK_FALSE(trainer.can_leave());
  trainer.update(0);

  INFO("a patient of one's own, without steps");
  trainer.start_page()->add(folder.path / "tiny");
  trainer.start_page()->choose_learner("L-07");
  begin(trainer);
  REQUIRE(trainer.session());
  CHECK(trainer.loaded_case()->subject.name == "Ball in a block");
  CHECK_FALSE(trainer.session()->runner());
  CHECK(trainer.session()->only_learner());
  CHECK_FALSE(trainer.demonstration());
  CHECK_FALSE(trainer.loses_by_leaving());
  trainer.show_start_page();

  INFO("what cannot begin leaves the page as it is");
  std::string of_nobody = kTinyScenario;
  of_nobody.replace(of_nobody.find("\"tiny\""), 6, "\"nobody\"");
  REQUIRE(trainer.start_page());
  trainer.start_page()->add(folder.file("nobody.toml", of_nobody));
  begin(trainer);
  CHECK(trainer.start_page());
  REQUIRE(trainer.problems().size() == 1);
  CHECK(trainer.problems().front().find("nobody") != std::string::npos);
  trainer.problems().clear();

  INFO("what is being loaded can be given up");
  trainer.start_page()->add(folder.path / "tiny");
  trainer.begin_chosen();
  REQUIRE(trainer.loading());
  CHECK(trainer.can_stop_loading());
  trainer.stop_loading();
  CHECK_FALSE(trainer.loading());
  REQUIRE(trainer.start_page());

  INFO("an exam can be left before it begins and when it is over");
  trainer.start_page()->add(folder.path / "exam.toml");
  trainer.start_page()->task = Task::exam;
  CHECK(trainer.start_page()->learner() == "L-07");
  begin(trainer);
  REQUIRE(trainer.session());
  CHECK(trainer.session()->strict());
  CHECK(trainer.briefing());
  CHECK(trainer.can_leave());
  trainer.start();
  for (int i = 0; i < 5; ++i) trainer.update(i / 30.0);
  CHECK_FALSE(trainer.can_leave());
  trainer.show_start_page();
  REQUIRE(trainer.session());
  trainer.hand_in_exam();
  CHECK(trainer.can_leave());
  trainer.show_start_page();
  REQUIRE(trainer.start_page());
  CHECK(trainer.start_page()->attempts().size() == 1);
  trainer.start_page()->add(folder.path / "exam.toml");
  trainer.start_page()->task = Task::exam;
  CHECK(trainer.start_page()->why_not().find("it is no. 1 of the results") != std::string::npos);
  trainer.begin_chosen();
  CHECK_FALSE(trainer.loading());

  INFO("what is dropped on the page is opened for the learner who is named there");
  trainer.start_page()->choose_learner("L-08");
  open_and_wait(trainer, folder.path / "tiny");
  REQUIRE(trainer.session());
  trainer.show_start_page();
  REQUIRE(trainer.start_page());
  CHECK(trainer.start_page()->learner() == "L-08");
  trainer.start_page()->add(folder.path / "exam.toml");

  INFO("practice loses by leaving");
  trainer.start_page()->task = Task::practice;
  begin(trainer);
  trainer.start();
  for (int i = 0; i < 5; ++i) trainer.update(1 + i / 30.0);
  CHECK(trainer.loses_by_leaving());
  CHECK(trainer.can_leave());

  INFO("from free practice, steps begin with their briefing, which leads back");
  trainer.session()->practise();
  trainer.brief();
  CHECK(trainer.briefing());
  CHECK_FALSE(trainer.session()->runner());
  trainer.leave_briefing();
  CHECK_FALSE(trainer.briefing());
  REQUIRE(trainer.session());
  CHECK_FALSE(trainer.session()->runner());
  trainer.brief();
  trainer.start();
  CHECK_FALSE(trainer.briefing());
  REQUIRE(trainer.session()->runner());
  trainer.brief();
  CHECK_FALSE(trainer.briefing());  // steps that run have been explained
}

TEST_CASE("a review of an attempt leads back to the page of learners, with what was chosen there") {
  const Patience patience;
  const test::TestContext context;
  const TrainerFolder folder;
  Options scored = folder.options();
  scored.results = folder.path / "lab.db";
  scored.learner = "L-07";
  {
    Trainer trainer(scored);
    trainer.open_from_options();
    trainer.finish_loading();
    for (int i = 0; trainer.session() && !trainer.session()->result() && i < 20'000; ++i) trainer.update(i / 30.0);
    trainer.write_results_if_due();
    REQUIRE(trainer.problems().empty());
  }
  Options options;
  options.out = folder.path / "out";
  options.results = scored.results;
  Trainer trainer(options);
  trainer.open_from_options();
  REQUIRE(trainer.start_page());
  trainer.start_page()->task = Task::learners;
  trainer.begin_chosen();
  REQUIRE(trainer.learners_page());
  CHECK_FALSE(trainer.start_page());
  CHECK(trainer.can_leave());
  CHECK_FALSE(trainer.loses_by_leaving());
  trainer.learners_page()->choose_learner("L-07");
  trainer.learners_page()->choose_author("T-02");
  trainer.learners_page()->add_comment("Well held");
  trainer.report_attempt();
  trainer.export_tables();
  const std::vector<Notice> notices = trainer.take_notices();
  REQUIRE(notices.size() == 2);
  CHECK(notices[0].text.find("report.html") != std::string::npos);
  CHECK(notices[1].text.find("out/tables/") != std::string::npos);

  INFO("a review that is given up leaves the page as it is");
  trainer.review();
  trainer.stop_loading();
  REQUIRE(trainer.learners_page());
  CHECK(trainer.options().mode == Mode::practice);
  trainer.review();
  trainer.finish_loading();
  REQUIRE(trainer.replay());
  CHECK(trainer.leads_to_learners());
  trainer.leave();
  REQUIRE(trainer.learners_page());
  CHECK(trainer.learners_page()->choice().learner == "L-07");
  CHECK(trainer.learners_page()->choice().author == "T-02");
  CHECK(trainer.learners_page()->comments().size() == 1);

  INFO("and a replay that the start page begins leads there");
  trainer.leave();
  REQUIRE(trainer.start_page());
  trainer.start_page()->task = Task::replay;
  begin(trainer);
  REQUIRE(trainer.replay());
  CHECK_FALSE(trainer.leads_to_learners());
  trainer.leave();
  CHECK(trainer.start_page());

  INFO("what is dropped on the page of learners is opened");
  trainer.show_learners();
  REQUIRE(trainer.learners_page());
  open_and_wait(trainer, folder.path / "tiny");
  CHECK(trainer.session());
}

TEST_CASE("the first patient can be given up, and an exam that the command line asks for cannot") {
  const Patience patience;
  const test::TestContext context;
  const TrainerFolder folder;
  Options options = folder.options();
  options.tracker = "mouse:";
  Trainer practice(options);
  practice.open_from_options();
  practice.stop_loading();
  CHECK(practice.start_page());
  options.mode = Mode::exam;
  options.learner = "L-07";
  Trainer exam(options);
  exam.open_from_options();
  CHECK_FALSE(exam.can_stop_loading());
  exam.stop_loading();
  CHECK_FALSE(exam.start_page());
  CHECK(exam.loading());
}

TEST_CASE("a command line that names nothing usable leads to the start page, with the reason") {
  const Patience patience;
  const test::TestContext context;
  const TrainerFolder folder;
  Options options;
  options.out = folder.path / "out";
  options.ct = folder.path / "nowhere.nii.gz";
  options.tracker = "mouse:";
  Trainer trainer(options);
  trainer.open_from_options();
  CHECK_FALSE(trainer.start_page());
  trainer.finish_loading();
  REQUIRE(trainer.problems().size() == 1);
  CHECK(trainer.problems().front().find("nowhere.nii.gz") != std::string::npos);
  CHECK(trainer.start_page());
}

TEST_CASE("a tracker that has gone since it was chosen leads back to the start page, with the reason") {
  const Patience patience;
  const test::TestContext context;
  const TrainerFolder folder;
  Options options;
  options.out = folder.path / "out";
  Trainer trainer(options);
  trainer.open_from_options();
  REQUIRE(trainer.start_page());
  std::vector<ProbeSample> samples(2);
  samples[1].time_s = 1;
  const fs::path log = folder.file("sensor.igs.mha", write_sequence(samples));
  trainer.start_page()->choose_tracker("replay:" + log.string());
  trainer.start_page()->task = Task::setup;
  fs::remove(log);
  begin(trainer);
  REQUIRE(trainer.problems().size() == 1);
  CHECK(trainer.problems().front().find("sensor.igs.mha") != std::string::npos);
  CHECK(trainer.start_page());
}

TEST_CASE("a CT is listed once, and no longer when it cannot be used") {
  const Patience patience;
  const test::TestContext context;
  const TrainerFolder folder;
  Options options;
  options.out = folder.path / "out";
  Trainer trainer(options);
  trainer.open_from_options();
  REQUIRE(trainer.start_page());
  const std::size_t before = trainer.start_page()->patients().size();
  const auto broken = folder.file("broken.nii.gz", "\x1f\x8b not really");
  for (int time = 0; time < 2; ++time) trainer.start_page()->add(broken);
  CHECK(trainer.start_page()->patients().size() == before + 1);
  CHECK(trainer.start_page()->patient == before);

  trainer.begin_chosen();
  trainer.finish_loading();
  CHECK(trainer.problems().size() == 1);
  REQUIRE(trainer.start_page());
  CHECK(trainer.start_page()->patients().size() == before);
  CHECK(trainer.start_page()->patient == 0);
}

TEST_CASE("settings are taken on the start page and kept, and a database that cannot be opened is not taken") {
  const Patience patience;
  const test::TestContext context;
  const TrainerFolder folder;
  Options options;
  options.out = folder.path / "out";
  const auto file = folder.path / "settings.toml";
  Trainer trainer(options, {}, file);
  trainer.open_from_options();
  REQUIRE(trainer.start_page());
  trainer.start_page()->choose_learner("L-07");
  const auto own = trainer.start_page()->database();

  Preferences wanted;
  wanted.results = folder.file("notes.txt", std::string(4096, 'x'));
  wanted.look.marker = MarkerSide::right;
  trainer.prefer(wanted);
  CHECK(trainer.problems().size() == 1);
  CHECK(trainer.preferences().results.empty());
  CHECK(trainer.start_page()->database() == own);
  CHECK(read_preferences(file).results.empty());
  CHECK(read_preferences(file).look.marker == MarkerSide::right);

  trainer.problems().clear();
  wanted.results = folder.path / "lab.db";
  wanted.out = folder.path / "elsewhere";
  trainer.prefer(wanted);
  CHECK(trainer.problems().empty());
  CHECK(trainer.start_page()->database() == wanted.results);
  CHECK(trainer.start_page()->learner() == "L-07");
  CHECK(trainer.options().out == wanted.out);
  CHECK(read_preferences(file) == wanted);
}

TEST_CASE("the next start offers what was opened, the newest last, and forgets nothing that is away for a while") {
  const Patience patience;
  const test::TestContext context;
  const TrainerFolder folder;
  Options options;
  options.out = folder.path / "out";
  const auto file = folder.path / "settings.toml", away = folder.path / "disk" / "away.nii.gz";
  const auto other = folder.path / "other";
  std::filesystem::copy(folder.path / "tiny", other, std::filesystem::copy_options::recursive);
  Preferences before;
  before.patients = {folder.path / "tiny", away};
  write_preferences(file, before);
  {
    Trainer trainer(options, read_preferences(file), file);
    trainer.open_from_options();
    REQUIRE(trainer.start_page());
    CHECK(trainer.start_page()->opened_patients() == std::vector{folder.path / "tiny"});
    trainer.start_page()->add(other);
    trainer.start_page()->choose_tracker("igtl://localhost:18999/Probe");
    trainer.show_learners();  // and back, by which nothing is lost
    trainer.show_start_page();
    CHECK(read_preferences(file).patients == std::vector{folder.path / "tiny", away, other});
    CHECK(read_preferences(file).network_tracker == "igtl://localhost:18999/Probe");
    trainer.start_page()->choose_tracker("mouse:");
    trainer.start_page()->add(folder.path / "tiny");
    begin(trainer);
    trainer.show_start_page();
    REQUIRE(trainer.start_page());
    CHECK(trainer.start_page()->patients()[trainer.start_page()->patient].source.case_folder == folder.path / "tiny");
    CHECK(read_preferences(file).patients == std::vector{away, other, folder.path / "tiny"});
    trainer.start_page()->task = Task::learners;
    trainer.open(other);  // as Ctrl O does
    trainer.finish_loading();
    REQUIRE(trainer.session());
    trainer.show_start_page();
    CHECK(trainer.start_page()->task == Task::patients);
  }
  CHECK(read_preferences(file).patients == std::vector{away, folder.path / "tiny", other});
  CHECK(read_preferences(file).network_tracker == "igtl://localhost:18999/Probe");
}
