// Plans of logs that the case or the picture does not allow.
#include <catch2/catch.hpp>

#include "tests/core/temporary_folder.h"
#include "tests/scenarios/tiny_case.h"
#include "tools/make_log/act.h"
#include "tools/make_log/hand.h"

using namespace insonate;

namespace {

/// From the view of the ball to a place beside it, without a tremor, and there `doing`.
LogPlan plan_of(const PlannedMove& move) {
  LogPlan plan;
  plan.unsteadiness_mm = plan.unsteadiness_deg = plan.tremor_mm = 0;
  plan.moves = {PlannedMove{}, move};
  plan.moves[0].view = "ball";
  return plan;
}

PlannedMove move_to(const std::string& view) {
  PlannedMove move;
  move.view = view;
  return move;
}

}  // namespace

TEST_CASE("a plan that goes where the case has no view or no body is refused with what to change") {
  const Case subject = tiny_case();
  CHECK_FALSE(move_by_hand(plan_of(move_to("ball")), subject).samples.empty());
  CHECK_THROWS_WITH(move_by_hand(plan_of(move_to("bal")), subject),
                    "Ball in a block: the view 'bal' is not in the case; did you mean 'ball'?");
  PlannedMove beside = move_to("ball");
  beside.lateral_mm = 300;
  CHECK_THROWS_WITH(
      move_by_hand(plan_of(beside), subject),
      Catch::StartsWith("Ball in a block: ") &&
          Catch::Contains(" s into the log: the probe points past the body; bring the move's lateral_mm"));
}

TEST_CASE("what a plan's hand is to do with what the picture does not have is refused with its words") {
  const Case subject = tiny_case();
  const Pose away = turned(0, {1, 0, 0}, {0, 0, 60});
  const struct {
    std::string doing;
    Pose pose;
    std::string says;
  } bad[] = {
      {"caliper_on 1 ball depth far", Pose{}, "'far' is not a number"},
      {"point_at top 1mm", Pose{}, "'1mm' is not a number"},
      {"point_at tip 0", Pose{}, "the landmark 'tip' is not in the case"},
      {"label_at bone", Pose{}, "the structure 'bone' is not in the case"},
      {"label_at ball", away, "the picture does not show it"},
  };
  for (const auto& [doing, pose, says] : bad) {
    INFO(doing);
    CHECK_THROWS_WITH(made_of(doing, subject, pose),
                      Catch::StartsWith("Ball in a block: do = \"" + doing + "\": " + says + "; correct the plan"));
  }
  CHECK(made_of("label_at ball", subject, Pose{}).size() == 1);
}

TEST_CASE("a plan whose hand goes nowhere is refused") {
  const TemporaryFolder folder;
  const std::string head = "scenario = \"exam.toml\"\nseed = 1\n", move = "[[move]]\nview = \"ball\"\n";
  CHECK(read_log_plan(folder.put("plan.toml", head + move + move)).moves.size() == 2);
  CHECK_THROWS_WITH(read_log_plan(folder.put("plan.toml", head + move)),
                    Catch::Contains("there are fewer than two moves; add a [[move]] for where the log begins"));
}
