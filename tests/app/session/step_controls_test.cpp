#include "app/session/step_controls.h"

#include <catch2/catch.hpp>

#include "app/session/picture_tools.h"
#include "devices/mouse/mouse_tracker.h"
#include "devices/replay/replay_tracker.h"
#include "scenarios/steps/question.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

std::string step(const std::string& kind, const std::string& keys) {
  return "[[step]]\nkind = \"" + kind + "\"\ntitle = \"" + kind + "\"\ninstruction = \"Do it.\"\n" + keys + "\n";
}

std::shared_ptr<const LoadedCase> loaded_case_of(const std::string& steps, const std::string& head = "") {
  auto loaded_case = std::make_shared<LoadedCase>();
  loaded_case->subject = tiny_case();
  loaded_case->tissues = tiny_tissues();
  loaded_case->scenario =
      parse_scenario("format = 2\ntitle = \"Steps\"\ncase = \"tiny\"\npass_mark_percent = 50\ntime_limit_s = 600\n" +
                         head + steps + "[[criterion]]\nmetric = \"time_s\"\nfull = 10\nzero = 100\n",
                     "exam.toml");
  return loaded_case;
}

struct Desk {
  Session session;
  StepControls controls;
  double now_s = 0;

  explicit Desk(const std::string& steps, const std::string& head = "")
      : session(loaded_case_of(steps, head), [] { return std::make_unique<MouseTracker>(Pose{}); }) {
    pass();
  }
  void pass() {
    session.advance(now_s += 1.0 / 30);
    controls.see(session);
  }
  void go_on() {
    controls.go_on(session);
    pass();
  }
  std::size_t step() const { return session.runner()->live().step; }
};

const std::string kNumber = "answer = \"number\"\nright_number = 30\nwithin = 2\nunit = \"mm\"\n";
const std::string kScored = "[[step.criterion]]\nmetric = \"answer_right_percent\"\nfull = 100\nzero = 0\n";

}  // namespace

TEST_CASE("an answer is drafted, and given once") {
  Desk desk(step("question", kNumber + kScored) + step("question", "choices = [\"yes\", \"no\"]\nright = \"yes\"") +
            step("free_scan", ""));
  REQUIRE(desk.controls.question());
  CHECK(desk.controls.question()->unit == "mm");
  for (const char* none : {"", "thirty", "30 mm", "1e999"}) {
    desk.controls.draft(none);
    CHECK_FALSE(desk.controls.can_answer());
    desk.go_on();
    CHECK(desk.step() == 0);
  }
  desk.controls.draft(" 31.5");
  CHECK(desk.controls.can_answer());
  INFO("confirmed twice before the exam has heard of it, it does not answer the next question too");
  desk.controls.go_on(desk.session);
  desk.controls.go_on(desk.session);
  desk.pass();
  CHECK(desk.step() == 1);
  CHECK(desk.session.runner()->result().steps[0].criteria[0].points == 1);
  CHECK(desk.controls.draft().empty());
  CHECK_FALSE(desk.controls.can_answer());
  desk.controls.draft("no");
  desk.go_on();
  CHECK(desk.step() == 2);
}

TEST_CASE("a step that is not done is left at the second asking") {
  Desk desk(step("mark_point", "landmark = \"top\"") + step("mark_point", "landmark = \"top\"") +
            step("free_scan", ""));
  desk.go_on();
  CHECK(desk.step() == 0);
  CHECK(desk.controls.asks_again());
  desk.controls.stay();
  CHECK_FALSE(desk.controls.asks_again());
  desk.go_on();
  CHECK(desk.step() == 0);
  desk.go_on();
  CHECK(desk.step() == 1);
  CHECK_FALSE(desk.controls.asks_again());
  CHECK(desk.session.runner()->result().steps[0].outcome == StepOutcome::went_on);

  INFO("what is done after the first asking ends the question");
  desk.go_on();
  CHECK(desk.controls.asks_again());
  desk.session.act({ActionKind::point, {0, 45}});
  desk.pass();
  CHECK_FALSE(desk.controls.asks_again());
  CHECK(desk.step() == 1);

  INFO("one that is done is left at once");
  desk.session.act({ActionKind::point, {0, 45}});
  desk.pass();
  desk.go_on();
  CHECK(desk.step() == 2);
  CHECK(desk.session.runner()->result().steps[1].outcome == StepOutcome::done);
  desk.go_on();
  CHECK(desk.session.runner()->live().finished);
  CHECK_FALSE(StepControls::active(desk.session));
}

TEST_CASE("a hint shows its cost before it is taken, and costs once however often the button is pressed") {
  Desk desk(step("free_scan",
                 "[[step.hint]]\ntext = \"first\"\ncost = [0, 1, 3]\n[[step.hint]]\ntext = \"second\"\n"
                 "cost = 0.5"),
            "difficulty = \"hard\"\n");
  CHECK(*StepControls::hint_cost(desk.session) == 3);
  desk.controls.take_hint(desk.session);
  desk.controls.take_hint(desk.session);
  desk.pass();
  CHECK(desk.session.runner()->live().hints == std::vector<std::string>{"first"});
  CHECK(*StepControls::hint_cost(desk.session) == 0.5);
  desk.controls.take_hint(desk.session);
  desk.pass();
  CHECK_FALSE(StepControls::hint_cost(desk.session));

  Desk warm_up(step("free_scan", "counts = false\n[[step.hint]]\ntext = \"first\"\ncost = 2") + step("free_scan", ""));
  CHECK(*StepControls::hint_cost(warm_up.session) == 0);
}

TEST_CASE("where the order is free the learner turns to steps that are not over") {
  const std::string steps =
      step("free_scan", "name = \"one\"") + step("free_scan", "name = \"two\"") + step("free_scan", "name = \"three\"");
  CHECK(StepControls::turns(Desk(steps).session).empty());
  Desk desk(steps, "order = \"free\"\n");
  desk.controls.turn_to(desk.session, 2);
  desk.pass();
  CHECK(desk.step() == 2);
  desk.go_on();
  CHECK(desk.step() == 0);
  const std::vector<StepControls::Turn> turns = StepControls::turns(desk.session);
  REQUIRE(turns.size() == 3);
  CHECK((turns[0].current && !turns[0].can_turn && !turns[0].ended));
  CHECK((!turns[1].current && turns[1].can_turn && !turns[1].ended));
  CHECK((!turns[2].current && !turns[2].can_turn && turns[2].ended));
  desk.controls.turn_to(desk.session, 2);
  desk.pass();
  CHECK(desk.step() == 0);
}

TEST_CASE("knobs are shown as asked for and as set") {
  Desk desk(step("set_knobs", "probe = \"linear\"\ndepth_mm = [50, 65]\ngain_db = [-3, 3]"));
  desk.session.set(ActionKind::depth, 120);
  std::vector<SettingsInput::Setting> knobs = desk.controls.settings(desk.session);
  REQUIRE(knobs.size() == 3);
  CHECK((knobs[0].name == "Probe" && !knobs[0].right));
  CHECK((knobs[1].wanted == "5 to 6.5 cm" && knobs[1].now == "12 cm" && !knobs[1].right));
  CHECK((knobs[2].wanted == "-3 to 3 dB" && knobs[2].now == "0 dB" && knobs[2].right));
  desk.session.set(ActionKind::depth, 65);
  CHECK(desk.controls.settings(desk.session)[1].right);
}

TEST_CASE("a log takes nothing from who watches it") {
  Session session(loaded_case_of(step("free_scan", "")), [] {
    return std::make_unique<ReplayTracker>("a log", samples_of(5, 60, [](double) { return Pose{}; }),
                                           ReplayTracker::Options{}, Recording{"a.igs.mha", "", ""});
  });
  StepControls controls;
  session.advance(0);
  controls.see(session);
  session.advance(1);
  controls.see(session);
  CHECK_FALSE(StepControls::active(session));
  controls.go_on(session);
  session.freeze(true);
  session.advance(2);
  CHECK_FALSE(session.runner()->live().finished);
  CHECK(session.frozen_picture());
  CHECK_FALSE(PictureTools::ready(session));
  session.practise();
  session.freeze(true);
  session.advance(2.1);
  CHECK(PictureTools::ready(session));
}
