#include "scenarios/results/rescoring.h"

#include <nlohmann/json.hpp>

#include <algorithm>

#include "scenarios/result_json.h"

namespace insonate {
namespace {

using Json = nlohmann::json;

/// Returns the first value in which two results differ, as JSON: "percent: 81.5 then, 79 now". Empty if there is none.
std::string first_difference(const std::string& then_json, const std::string& now_json) {
  Json then = Json::parse(then_json), now = Json::parse(now_json);
  for (Json* json : {&then, &now}) {
    json->erase("made_from");
    json->erase("scoring_version");
  }
  const Json changes = Json::diff(then, now);
  if (changes.empty()) return "";
  const Json::json_pointer place(changes.front().at("path").get<std::string>());
  const auto at_place = [&](const Json& json) { return json.contains(place) ? json.at(place).dump() : "nothing"; };
  return place.to_string().substr(1) + ": " + at_place(then) + " then, " + at_place(now) + " now";
}

}  // namespace

std::string why_different(const std::string& score_json, ExamResult now, const std::string& name) {
  const ExamResult stored = result_from_json(score_json, name);
  const Provenance& then = stored.provenance;
  // Older scores do not name the limits that kept a view from being held.
  const auto names_limits = [](const auto& fact) { return fact.first == StepResult::kNotHeld; };
  for (std::size_t i = 0; i < std::min(now.steps.size(), stored.steps.size()); ++i)
    if (std::ranges::none_of(stored.steps[i].facts, names_limits)) std::erase_if(now.steps[i].facts, names_limits);
  now.provenance.program_version = then.program_version;
  now.provenance.mode = then.mode;
  now.provenance.log = then.log;
  now.provenance.log_digest = then.log_digest;
  now.provenance.log_transform = then.log_transform;
  const std::string now_json = to_json(now);
  if (now_json == score_json) return "";

  std::string why;
  const auto add = [&](const std::string& reason) { why += (why.empty() ? "" : "; ") + reason; };
  const auto compare = [&](const char* what, const std::string& before, const std::string& after) {
    if (before != after) add(std::string("the ") + what + " is another, " + before + " then and " + after + " now");
  };
  compare("scoring's version", std::to_string(then.scoring_version), std::to_string(now.provenance.scoring_version));
  compare("scenario", then.scenario_digest, now.provenance.scenario_digest);
  compare("case", then.case_digest, now.provenance.case_digest);
  const std::string difference = first_difference(score_json, now_json);
  add(difference.empty() ? "all marks and values are the same" : difference);
  return why;
}

}  // namespace insonate
