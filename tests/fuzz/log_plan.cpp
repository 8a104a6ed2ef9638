// Plans of logs, and what their hands do in the picture.
#include "tests/fuzz/fuzz_target.h"
#include "tests/scenarios/tiny_case.h"
#include "tools/make_log/act.h"
#include "tools/make_log/plan.h"

namespace insonate::fuzz {
namespace {

const Target log_plan_target("log_plan", [](std::string_view bytes) -> std::string {
  const LogPlan plan = read_log_plan(file_with("plan.toml", bytes));
  if (plan.moves.size() < 2) return "a plan of fewer than two moves was taken";
  if (!(plan.rate_hz >= 10 && plan.rate_hz <= 250)) return "the rate is out of range";
  static const Case subject = tiny_case();
  for (const PlannedMove& move : plan.moves)
    for (const std::string& doing : move.doing) made_of(doing, subject, Pose{});
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
