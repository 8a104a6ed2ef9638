#include "scenarios/result_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenarios/json_problem.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"

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

template <typename T, typename Of>
concept ConstOrNot = std::same_as<std::remove_const_t<T>, Of>;

// Each struct lists its fields once, in the order of the file: `visit` is called with a key and the field, to write it
// or to read it.

template <typename Visit, ConstOrNot<MotionValues> Values>
void each_field(Visit& visit, Values& motion) {
  visit("time_s", motion.time_s);
  visit("path_length_mm", motion.path_length_mm);
  visit("angular_path_deg", motion.angular_path_deg);
  visit("translational_movements", motion.translational_movements);
  visit("rotational_movements", motion.rotational_movements);
  visit("tracked_s", motion.tracked_s);
  visit("on_skin_s", motion.on_skin_s);
  visit("untracked_s", motion.untracked_s);
  visit("dropouts", motion.dropouts);
  visit("log_dimensionless_jerk", motion.log_dimensionless_jerk);
  visit("spectral_arc_length", motion.spectral_arc_length);
}

template <typename Visit, ConstOrNot<ViewValues> Values>
void each_field(Visit& visit, Values& view) {
  for (const auto& [metric, value] : ViewValues::fields()) visit(info(metric).name, view.*value);
}

template <typename Visit, ConstOrNot<CriterionScore> Score>
void each_field(Visit& visit, Score& score) {
  visit("metric", score.metric);
  visit("value", score.value);
  visit("full", score.full);
  visit("zero", score.zero);
  visit("weight", score.weight);
  visit("critical", score.critical);
  visit("points", score.points);
  visit("why", score.why);
}

template <typename Visit, ConstOrNot<StepResult> Step>
void each_field(Visit& visit, Step& step) {
  visit("title", step.title);
  visit("kind", step.kind);
  visit("counts", step.counts);
  visit("view", step.view);
  visit("outcome", step.outcome);
  visit("start_s", step.start_s);
  visit("end_s", step.end_s);
  visit("longest_hold_s", step.longest_hold_s);
  visit("judged_from_s", step.judged_from_s);
  visit("judged_to_s", step.judged_to_s);
  visit("judged", step.judged);
  visit("hints_taken", step.hints_taken);
  visit("hint_cost", step.hint_cost);
  visit.if_any("guide_times", step.guide_times);
  visit.if_any("guide_s", step.guide_s);
  visit("values", step.values);
  visit("facts", step.facts);
  visit("motion", step.motion);
  visit("criteria", step.criteria);
}

template <typename Visit, ConstOrNot<Provenance> From>
void each_field(Visit& visit, From& from) {
  visit("program_version", from.program_version);
  visit("scenario", from.scenario);
  visit("scenario_digest", from.scenario_digest);
  visit("variant", from.variant);
  visit("case", from.case_name);
  visit("case_digest", from.case_digest);
  visit("log", from.log);
  visit("log_digest", from.log_digest);
  visit("log_transform", from.log_transform);
  visit("seed", from.seed);
  visit.if_any("mode", from.mode);
  visit("phantom_options", from.phantom_options);
}

template <typename Visit, ConstOrNot<ExamResult> Result>
void each_field(Visit& visit, Result& result) {
  visit("scoring_version", result.provenance.scoring_version);
  visit("title", result.title);
  visit.if_any("briefing", result.briefing);
  visit("complete", result.complete);
  visit("passed", result.passed);
  visit("percent", result.percent);
  visit("pass_mark_percent", result.pass_mark_percent);
  visit("points", result.points);
  visit("points_possible", result.points_possible);
  visit("reasons", result.reasons);
  visit("steps", result.steps);
  visit("criteria", result.criteria);
  visit("motion", result.motion);
  visit("made_from", result.provenance);
}

/// Writes the fields that it visits into an object.
struct Writer {
  Json json = Json::object();

  template <typename T>
  void operator()(std::string_view key, const T& value) {
    json[std::string(key)] = of(value);
  }
  /// Writes a field that files may leave out.
  template <typename T>
  void if_any(std::string_view key, const std::optional<T>& value) {
    if (value) (*this)(key, *value);
  }
  void if_any(std::string_view key, const std::string& text) {
    if (!text.empty()) (*this)(key, text);
  }
  template <typename Number>
  requires std::is_arithmetic_v<Number>
  void if_any(std::string_view key, Number number) {
    if (number != 0) (*this)(key, number);
  }

private:
  template <typename T>
  static Json of(const T& value) {
    if constexpr (requires(Writer & writer) { each_field(writer, value); }) {
      Writer writer;
      each_field(writer, value);
      return writer.json;
    } else {
      return value;
    }
  }
  static Json of(Metric metric) { return info(metric).name; }
  static Json of(AttemptMode mode) { return name_of(mode); }
  static Json of(StepOutcome outcome) { return std::ranges::find(kOutcomes, outcome, &OutcomeName::outcome)->name; }
  template <typename T>
  static Json of(const std::optional<T>& value) {
    return value ? of(*value) : Json(nullptr);
  }
  template <typename T>
  static Json of(const std::vector<T>& list) {
    Json json = Json::array();
    for (const T& one : list) json.push_back(of(one));
    return json;
  }
  template <typename T>
  static Json of(const std::vector<std::pair<std::string, T>>& named) {
    Json json = Json::object();
    for (const auto& [name, value] : named) json[name] = of(value);
    return json;
  }
  static Json of(const std::vector<std::pair<Metric, double>>& measured) {
    Json json = Json::object();
    for (const auto& [metric, value] : measured) json[std::string(info(metric).name)] = value;
    return json;
  }
};

/// Reads the fields that it visits from an object. Throws an exception whose text says what is wrong.
struct Reader {
  const Json& json;

  template <typename T>
  void operator()(std::string_view key, T& value) {
    from(json.at(std::string(key)), value);
  }
  template <typename T>
  void if_any(std::string_view key, std::optional<T>& value) {
    if (json.contains(key)) (*this)(key, value.emplace());
  }
  template <typename T>
  void if_any(std::string_view key, T& value) {
    if (json.contains(key)) (*this)(key, value);
  }

private:
  template <typename T>
  static void from(const Json& json, T& value) {
    if constexpr (requires(Reader & reader) { each_field(reader, value); }) {
      Reader reader{json};
      each_field(reader, value);
    } else {
      read_value(json, value);
    }
  }
  template <typename T>
  static T named(const std::optional<T>& found, const char* what) {
    if (!found) throw std::runtime_error(std::string("an unknown ") + what);
    return *found;
  }
  static void from(const Json& json, Metric& metric) { metric = named(find_metric(json.get<std::string>()), "metric"); }
  static void from(const Json& json, AttemptMode& mode) {
    mode = named(find_attempt_mode(json.get<std::string>()), "mode");
  }
  static void from(const Json& json, StepOutcome& outcome) {
    const auto found = std::ranges::find_if(kOutcomes, [&](const OutcomeName& o) { return json == o.name; });
    if (found == kOutcomes.end()) throw std::runtime_error("an unknown outcome");
    outcome = found->outcome;
  }
  template <typename T>
  static void from(const Json& json, std::optional<T>& value) {
    value.reset();
    if (!json.is_null()) from(json, value.emplace());
  }
  template <typename T>
  static void from(const Json& json, std::vector<T>& list) {
    for (const Json& one : json) from(one, list.emplace_back());
  }
  template <typename T>
  static void from(const Json& json, std::vector<std::pair<std::string, T>>& named) {
    for (const auto& [name, value] : json.items()) from(value, named.emplace_back(name, T()).second);
  }
  static void from(const Json& json, std::vector<std::pair<Metric, double>>& measured) {
    for (const auto& [name, value] : json.items())
      measured.emplace_back(named(find_metric(name), "metric"), value.get<double>());
  }
};

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw InputError(name, "", "this is not a result of Insonate: " + why, "score the log again");
}

}  // namespace

std::string to_json(const ExamResult& result) {
  Writer writer;
  writer("format", kFormat);
  each_field(writer, result);
  // Names come from files. Invalid UTF-8 in them must not prevent the score from being written.
  return writer.json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ExamResult result_from_json(std::string_view text, const std::string& name) {
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != kFormat) throw std::runtime_error("a format that this program does not read");
    ExamResult result;
    Reader reader{json};
    each_field(reader, result);
    constexpr double kMaxTime_s = 1e9;  // far more than any scan, and its milliseconds are whole numbers
    if (!(result.motion.time_s >= 0 && result.motion.time_s <= kMaxTime_s))
      throw std::runtime_error(formatted("a scan of %g s", result.motion.time_s));
    return result;
  } catch (const Json::exception& error) {
    refuse(name, json_problem(error, text));
  } catch (const std::runtime_error& error) {
    refuse(name, error.what());
  }
}

}  // namespace insonate
