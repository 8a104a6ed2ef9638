// A kind of step that the project does not have: one class and one call. Reader, runner, points and the learner's
// controls take it without knowing it.

#include <catch2/catch.hpp>

#include "app/session/picture_tools.h"
#include "app/session/step_controls.h"
#include "devices/mouse/mouse_tracker.h"
#include "scenarios/steps/step_kinds.h"
#include "sim/files/toml_table.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

/// kind = "count": say how many there are.
struct Count : StepTask {
  double right = 0;  ///< right = 2: 0 to 100

  struct Run : StepRun {
    const Count& asked;
    std::optional<double> counted;
    explicit Run(const Count& task) : asked(task) {}
    void act(const Action& action, const Moment&) override {
      if (action.kind == ActionKind::answer) counted = AnswerInput::number_in(action.text);
    }
    bool done() const override { return counted.has_value(); }
    void finish(StepOutcome, double, StepResult& result) const override {
      if (counted) result.values.emplace_back(Metric::answer_error, std::abs(*counted - asked.right));
    }
  };

  static std::shared_ptr<const StepTask> read(const TomlTable& table, const Step&) {
    auto task = std::make_shared<Count>();
    task->right = table.number("right", {0, 100});
    return task;
  }
  StepInput input() const override { return AnswerInput{AnswerInput::Form::number, {}, "cysts"}; }
  StepWords words() const override { return {"Count them all.", "Counting"}; }
  std::vector<Metric> metrics() const override { return {Metric::answer_error}; }
  StepBegin prepare(const StepWorld&) const override {
    return [this](double) { return std::make_unique<Run>(*this); };
  }
};

Scenario counting() {
  static const bool added = (add_step_kind({"count", ViewUse::none, Count::read}), true);
  REQUIRE(added);
  return parse_scenario(
      "format = 2\ntitle = \"Count\"\ncase = \"tiny\"\npass_mark_percent = 50\ntime_limit_s = 60\n"
      "[[step]]\nkind = \"count\"\ntitle = \"Cysts\"\ninstruction = \"How many?\"\nright = 3\n"
      "[[step.criterion]]\nmetric = \"answer_error\"\nfull = 0\nzero = 2\n",
      "count.toml");
}

}  // namespace

TEST_CASE("a step kind of one class is read, put before the learner, and scored") {
  auto loaded_case = std::make_shared<LoadedCase>();
  loaded_case->subject = tiny_case();
  loaded_case->tissues = tiny_tissues();
  loaded_case->scenario = counting();
  Session session(loaded_case, [] { return std::make_unique<MouseTracker>(Pose{}); });
  StepControls controls;
  PictureTools tools;
  double now_s = 0;
  const auto pass = [&] {
    session.advance(now_s += 1.0 / 30);
    controls.see(session);
    tools.see(session);
  };
  pass();
  REQUIRE(controls.question());
  CHECK(controls.question()->unit == "cysts");
  CHECK(tools.free_choice());
  CHECK(std::string(session.loaded_case().scenario->steps[0].task->words().under_way) == "Counting");

  controls.draft("two");
  CHECK_FALSE(controls.can_answer());
  controls.draft("2");
  controls.go_on(session);
  pass();
  REQUIRE(session.result());
  const StepResult& step = session.result()->steps[0];
  CHECK(step.kind == "count");
  CHECK(step.outcome == StepOutcome::done);
  CHECK(step.criteria[0].points == Approx(0.5));
}
