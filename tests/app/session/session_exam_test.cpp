// Exams under strict rules, and what a scenario locks.

#include <catch2/catch.hpp>

#include "app/session/session.h"
#include "devices/registry.h"
#include "tests/app/session/tiny_session.h"

using namespace insonate;

TEST_CASE("the made-up hand of a rehearsal takes no steps, and the learner's own hand does") {
  Session session(
      tiny_loaded_case(), [] { return open_tracker("rehearsal:"); }, 0);
  CHECK_FALSE(session.can_take_steps());
  CHECK(session.activity() == Activity::practice);
  session.start_over(Activity::exam);
  CHECK(session.activity() == Activity::practice);
  session.take_probe();
  CHECK(session.can_take_steps());
  session.start_over(Activity::exam);
  CHECK(session.activity() == Activity::exam);
  session.give_back_probe();
  CHECK(session.activity() == Activity::practice);
}

TEST_CASE("under strict rules an exam is taken once and as it is") {
  std::vector<ProbeSample> coming;
  const auto loaded_case = tiny_loaded_case();
  Session session(
      loaded_case, [&] { return std::make_unique<HandFed>(coming); }, 0, ExamRules::strict);
  CHECK(session.strict());
  CHECK_FALSE(session.shows_anatomy());
  session.advance(10);
  const int attempt = session.attempt();
  const auto still_the_exam = [&] {
    return session.activity() == Activity::exam && session.holder() == Holder::tracker &&
           session.attempt() == attempt && session.runner();
  };
  coming = {sample_at(10.1, turned(0, {1, 0, 0}, {1, 2, 3}))};
  session.advance(10.2);
  REQUIRE(session.runner()->live().started);

  session.practise();
  CHECK(still_the_exam());
  session.take_probe();
  CHECK(still_the_exam());
  session.give_back_probe();
  CHECK(still_the_exam());
  session.start_over();
  CHECK(still_the_exam());
  session.move_probe([](const ProbeHand&, const Pose& from) { return Pose{from.rotation, from.point({7, 0, 0})}; });
  CHECK(still_the_exam());

  INFO("there are no hints, and freezing is no pause");
  session.act({ActionKind::hint});
  session.freeze(true);
  coming = {sample_at(12, turned(0, {1, 0, 0}, {1, 2, 3}))};
  session.advance(12);
  REQUIRE(session.actions().size() == 1);
  CHECK(session.actions().begin()->second == std::vector<Action>{{ActionKind::freeze}});
  CHECK(session.runner()->live().elapsed_s == Approx(1.9));

  INFO("what is left before its end is scored as far as it went, and that is the end of it");
  session.hand_in();
  REQUIRE(session.result());
  CHECK(session.shows_anatomy());
  CHECK(session.result()->provenance.mode == AttemptMode::exam);
  CHECK(session.result()->complete);
  CHECK_FALSE(session.result()->passed);
  CHECK(session.result()->steps[0].outcome == StepOutcome::scan_ended);
  session.start_over();
  session.practise();
  CHECK(still_the_exam());
  CHECK(session.result());
}

TEST_CASE("what a scenario locks of the machine stays as it is in an exam, and in no practice") {
  const auto loaded_case = [] {
    auto made = std::make_shared<LoadedCase>(*tiny_loaded_case());
    made->scenario->locked = {ActionKind::probe, ActionKind::depth, ActionKind::gain};
    return made;
  }();
  for (const ExamRules rules : {ExamRules::strict, ExamRules::open}) {
    const bool strict = rules == ExamRules::strict;
    CAPTURE(strict);
    std::vector<ProbeSample> coming{sample_at(10.1, Pose{})};
    Session session(
        loaded_case, [&] { return std::make_unique<HandFed>(coming); }, 0, rules);
    session.advance(10.2);
    CHECK(session.locks(ActionKind::depth) == strict);
    CHECK_FALSE(session.locks(ActionKind::frequency));
    const Machine before = session.machine();
    session.choose_probe("linear");
    session.set(ActionKind::depth, 55);
    session.set(ActionKind::gain, 7);
    session.set({ActionKind::time_gain, {4, 12}});
    session.set(ActionKind::dynamic_range, 40);
    session.set(ActionKind::frequency, 2.5);
    session.act({ActionKind::point, {1, 2}});
    coming = {sample_at(10.3, Pose{})};
    session.advance(10.3);
    const Machine& machine = session.runner()->machine();
    CHECK(machine.probe == (strict ? before.probe : "linear"));
    CHECK(machine.depth_mm == (strict ? before.depth_mm : 55));
    CHECK(machine.gain_db == (strict ? 0 : 7));
    CHECK(machine.frequency_mhz == 2.5);
    CHECK(session.machine().depth_mm == machine.depth_mm);
    CHECK(session.machine().time_gain_db[3] == (strict ? 0 : 12));
    CHECK(session.machine().dynamic_range_db == (strict ? before.dynamic_range_db : 40));
    CHECK(session.machine().probe == machine.probe);

    INFO("also while no sample comes, and no longer than the exam");
    session.set(ActionKind::gain, 9);
    session.advance(10.4);
    CHECK(session.machine().gain_db == (strict ? 0 : 9));
    session.hand_in();
    session.set(ActionKind::gain, 9);
    session.advance(10.5);
    CHECK(session.machine().gain_db == 9);
  }
}

TEST_CASE("an exam under strict rules that nobody has begun is not handed in") {
  std::vector<ProbeSample> coming;
  Session session(
      tiny_loaded_case(), [&] { return std::make_unique<HandFed>(coming); }, 0, ExamRules::strict);
  session.advance(1);
  session.hand_in();
  CHECK_FALSE(session.result());
  session.start_over();  // nothing was seen of it yet
  CHECK(session.activity() == Activity::exam);
}

TEST_CASE("an exam on a patient that has none of its views is refused in one sentence, a mistake with its place") {
  CaseSource source;
  source.ct = "chosen.nii.gz";
  source.kept = parse_scenario(kTinyScenario, "exam.toml");
  const auto own = tiny_loaded_case(false);
  CHECK(with_exam_of(source, own)->scenario->title == "Find the ball");
  const auto other = std::make_shared<LoadedCase>(*own);
  other->subject.views.clear();
  CHECK_THROWS_WITH(with_exam_of(source, other), Catch::Contains("'Find the ball' is made for another patient") &&
                                                     Catch::Contains("choose steps that are made for this patient"));
  INFO("on its own patient, the scenario's author has made a mistake");
  source.ct.clear();
  CHECK_THROWS_WITH(with_exam_of(source, other), Catch::Contains("names the view 'ball'"));
  source.case_folder = "cases/tiny";
  CHECK_THROWS_WITH(with_exam_of(source, other), Catch::Contains("names the view 'ball'"));
  source.case_folder = "cases/another";
  CHECK_THROWS_WITH(with_exam_of(source, other), Catch::Contains("is made for another patient"));
}
