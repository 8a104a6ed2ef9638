// What a learner did, as the frames of a log keep it.
#include "scenarios/action.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target actions_target("actions", [](std::string_view bytes) -> std::string {
  const std::vector<Action> actions = parse_actions(bytes, "log.mha", "frame 1");
  const std::string text = to_text(actions);
  return parse_actions(text, "log.mha", "frame 1") == actions ? "" : "written and read again they are others";
});

}  // namespace
}  // namespace insonate::fuzz
