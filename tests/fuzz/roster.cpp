// Lists of learners, the same bytes as CSV and as TOML.
#include "scenarios/results/roster.h"

#include <set>

#include "scenarios/results/learner_id.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

std::string broken_in(const std::filesystem::path& file) {
  const std::vector<std::string> ids = read_roster(file);
  if (ids.empty() || ids.size() > kMaxLearners) return "a list of none or of too many was taken";
  for (const std::string& id : ids)
    if (!why_no_learner_id(id).empty()) return "an id was taken that is none";
  if (std::set<std::string>(ids.begin(), ids.end()).size() != ids.size()) return "an id stands there twice";
  return "";
}

const Target roster_target("roster", [](std::string_view bytes) -> std::string {
  const std::string broken = broken_by([&] { return broken_in(file_with("roster.csv", bytes)); });
  return broken.empty() ? broken_in(file_with("roster.toml", bytes)) : broken;
});

}  // namespace
}  // namespace insonate::fuzz
