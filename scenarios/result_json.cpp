#include "scenarios/result_json.h"

#include <nlohmann/json.hpp>

#include <array>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 2;

struct OutcomeName {
  StepOutcome outcome;
  const char* name;
};
constexpr std::array kOutcomes{OutcomeName{StepOutcome::held, "held"},
                               OutcomeName{StepOutcome::done, "done"},
                               OutcomeName{StepOutcome::went_on, "went_on"},
                               OutcomeName{StepOutcome::timed_out, "timed_out"},
                               OutcomeName{StepOutcome::scan_ended, "scan_ended"},
                               OutcomeName{StepOutcome::skipped, "skipped"},
                               OutcomeName{StepOutcome::not_reached, "not_reached"}};

/// Lists each field once, for both writing and reading: calls `visit` with a key and the field.
template <typename Values, typename Visit>
void each_field_of_motion(Values& v, Visit&& visit) {
  visit("time_s", v.time_s);
  visit("path_length_mm", v.path_length_mm);
  visit("angular_path_deg", v.angular_path_deg);
  visit("translational_movements", v.translational_movements);
  visit("rotational_movements", v.rotational_movements);
  visit("tracked_s", v.tracked_s);
  visit("on_skin_s", v.on_skin_s);
  visit("untracked_s", v.untracked_s);
  visit("dropouts", v.dropouts);
}

template <typename Values, typename Visit>
void each_field_of_provenance(Values& v, Visit&& visit) {
  visit("program_version", v.program_version);
  visit("scenario", v.scenario);
  visit("scenario_digest", v.scenario_digest);
  visit("variant", v.variant);
  visit("case", v.case_name);
  visit("case_digest", v.case_digest);
  visit("log", v.log);
  visit("log_digest", v.log_digest);
  visit("log_transform", v.log_transform);
}

/// The fields that may be empty.
template <typename Values, typename Visit>
void each_optional_field_of_motion(Values& v, Visit&& visit) {
  visit("log_dimensionless_jerk", v.log_dimensionless_jerk);
  visit("spectral_arc_length", v.spectral_arc_length);
}

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::optional<double> number_or_null(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

Json json_of(const ViewValues& view) {
  Json json;
  for (const auto& [metric, value] : ViewValues::fields()) json[std::string(info(metric).name)] = view.*value;
  return json;
}

Json json_of(const MotionValues& motion) {
  Json json;
  each_field_of_motion(motion, [&](const char* key, const auto& value) { json[key] = value; });
  each_optional_field_of_motion(motion, [&](const char* key, const auto& value) { json[key] = or_null(value); });
  return json;
}

MotionValues motion_from(const Json& json) {
  MotionValues motion;
  each_field_of_motion(motion, [&](const char* key, auto& value) { json.at(key).get_to(value); });
  each_optional_field_of_motion(motion, [&](const char* key, auto& value) { value = number_or_null(json, key); });
  return motion;
}

Json json_of(const std::vector<CriterionScore>& criteria) {
  Json list = Json::array();
  for (const CriterionScore& m : criteria)
    list.push_back({{"metric", info(m.metric).name},
                    {"value", or_null(m.value)},
                    {"full", m.full},
                    {"zero", m.zero},
                    {"weight", m.weight},
                    {"critical", m.critical},
                    {"points", m.points},
                    {"why", m.why}});
  return list;
}

Metric metric_named(const std::string& name) {
  const auto metric = find_metric(name);
  if (!metric) throw std::runtime_error("an unknown metric");
  return *metric;
}

std::vector<CriterionScore> criteria_from(const Json& list) {
  std::vector<CriterionScore> criteria;
  for (const Json& json : list) {
    CriterionScore m;
    m.metric = metric_named(json.at("metric").get<std::string>());
    m.value = number_or_null(json, "value");
    json.at("full").get_to(m.full);
    json.at("zero").get_to(m.zero);
    json.at("weight").get_to(m.weight);
    json.at("critical").get_to(m.critical);
    json.at("points").get_to(m.points);
    json.at("why").get_to(m.why);
    criteria.push_back(std::move(m));
  }
  return criteria;
}

Json json_of(const StepResult& step) {
  const char* outcome = "";
  for (const OutcomeName& o : kOutcomes)
    if (o.outcome == step.outcome) outcome = o.name;
  Json values = Json::object(), facts = Json::object();
  for (const auto& [metric, value] : step.values) values[std::string(info(metric).name)] = value;
  for (const auto& [what, fact] : step.facts) facts[what] = fact;
  return {{"title", step.title},
          {"kind", step.kind},
          {"counts", step.counts},
          {"view", step.view},
          {"outcome", outcome},
          {"start_s", step.start_s},
          {"end_s", step.end_s},
          {"longest_hold_s", step.longest_hold_s},
          {"judged_from_s", or_null(step.judged_from_s)},
          {"judged_to_s", or_null(step.judged_to_s)},
          {"judged", step.judged ? json_of(*step.judged) : Json(nullptr)},
          {"hints_taken", step.hints_taken},
          {"hint_cost", step.hint_cost},
          {"values", values},
          {"facts", facts},
          {"motion", json_of(step.motion)},
          {"criteria", json_of(step.criteria)}};
}

StepResult step_from(const Json& json) {
  StepResult step;
  json.at("title").get_to(step.title);
  json.at("kind").get_to(step.kind);
  json.at("counts").get_to(step.counts);
  json.at("hints_taken").get_to(step.hints_taken);
  json.at("hint_cost").get_to(step.hint_cost);
  json.at("view").get_to(step.view);
  const OutcomeName* outcome = nullptr;
  for (const OutcomeName& o : kOutcomes)
    if (json.at("outcome") == o.name) outcome = &o;
  if (!outcome) throw std::runtime_error("an unknown outcome");
  step.outcome = outcome->outcome;
  json.at("start_s").get_to(step.start_s);
  json.at("end_s").get_to(step.end_s);
  json.at("longest_hold_s").get_to(step.longest_hold_s);
  step.judged_from_s = number_or_null(json, "judged_from_s");
  step.judged_to_s = number_or_null(json, "judged_to_s");
  if (const Json& judged = json.at("judged"); !judged.is_null()) {
    step.judged.emplace();
    for (const auto& [metric, value] : ViewValues::fields())
      judged.at(std::string(info(metric).name)).get_to((*step.judged).*value);
  }
  for (const auto& [name, value] : json.at("values").items()) step.values.emplace_back(metric_named(name), value);
  for (const auto& [what, fact] : json.at("facts").items()) step.facts.emplace_back(what, fact);
  step.motion = motion_from(json.at("motion"));
  step.criteria = criteria_from(json.at("criteria"));
  return step;
}

AttemptMode mode_named(const std::string& name) {
  const auto mode = find_attempt_mode(name);
  if (!mode) throw std::runtime_error("an unknown mode");
  return *mode;
}

ExamResult result_from(const Json& json) {
  if (json.at("format") != kFormat) throw std::runtime_error("a format that this program does not read");
  ExamResult result;
  json.at("scoring_version").get_to(result.provenance.scoring_version);
  json.at("title").get_to(result.title);
  json.at("complete").get_to(result.complete);
  json.at("passed").get_to(result.passed);
  json.at("percent").get_to(result.percent);
  json.at("pass_mark_percent").get_to(result.pass_mark_percent);
  json.at("points").get_to(result.points);
  json.at("points_possible").get_to(result.points_possible);
  json.at("reasons").get_to(result.reasons);
  for (const Json& step : json.at("steps")) result.steps.push_back(step_from(step));
  result.criteria = criteria_from(json.at("criteria"));
  result.motion = motion_from(json.at("motion"));
  const Json& made_from = json.at("made_from");
  each_field_of_provenance(result.provenance,
                           [&](const char* key, std::string& value) { made_from.at(key).get_to(value); });
  made_from.at("seed").get_to(result.provenance.seed);
  if (made_from.contains("mode")) result.provenance.mode = mode_named(made_from["mode"].get<std::string>());
  for (const auto& [name, value] : made_from.at("phantom_options").items())
    result.provenance.phantom_options.emplace_back(name, value.get<std::string>());
  return result;
}

}  // namespace

std::string to_json(const ExamResult& result) {
  Json made_from;
  each_field_of_provenance(result.provenance,
                           [&](const char* key, const std::string& value) { made_from[key] = value; });
  made_from["seed"] = result.provenance.seed;
  if (result.provenance.mode) made_from["mode"] = name_of(result.provenance.mode);
  made_from["phantom_options"] = Json::object();
  for (const auto& [name, value] : result.provenance.phantom_options) made_from["phantom_options"][name] = value;

  Json steps = Json::array();
  for (const StepResult& step : result.steps) steps.push_back(json_of(step));
  const Json json = {{"format", kFormat},
                     {"scoring_version", result.provenance.scoring_version},
                     {"title", result.title},
                     {"complete", result.complete},
                     {"passed", result.passed},
                     {"percent", result.percent},
                     {"pass_mark_percent", result.pass_mark_percent},
                     {"points", result.points},
                     {"points_possible", result.points_possible},
                     {"reasons", result.reasons},
                     {"steps", steps},
                     {"criteria", json_of(result.criteria)},
                     {"motion", json_of(result.motion)},
                     {"made_from", made_from}};
  // Names come from files. Invalid UTF-8 in them must not prevent the score from being written.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ExamResult result_from_json(std::string_view text, const std::string& name) {
  try {
    return result_from(Json::parse(text));
  } catch (const std::exception& error) {
    throw InputError(name, "", std::string("this is no result of insonate: ") + error.what(), "score the log again");
  }
}

}  // namespace insonate
