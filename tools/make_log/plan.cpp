#include "tools/make_log/plan.h"

#include <array>

#include "sim/core/files.h"
#include "sim/core/suggest.h"
#include "sim/core/toml_table.h"

namespace insonate {
namespace {

double number_or(const TomlTable& table, const char* key, double least, double most, double otherwise) {
  return table.has(key) ? table.number(key, least, most) : otherwise;
}

PlannedMove read_move(const TomlTable& table) {
  table.allow_only({"view", "lateral_mm", "elevation_mm", "tilt_deg", "rock_deg", "rotation_deg", "lift_mm", "seconds",
                    "overshoot", "corrections", "search_deg", "search_s", "rest_s", "do", "pause_s"});
  PlannedMove move;
  move.view = table.text("view");
  move.lateral_mm = number_or(table, "lateral_mm", -300, 300, move.lateral_mm);
  move.elevation_mm = number_or(table, "elevation_mm", -300, 300, move.elevation_mm);
  move.tilt_deg = number_or(table, "tilt_deg", -90, 90, move.tilt_deg);
  move.rock_deg = number_or(table, "rock_deg", -90, 90, move.rock_deg);
  move.rotation_deg = number_or(table, "rotation_deg", -180, 180, move.rotation_deg);
  move.lift_mm = number_or(table, "lift_mm", 0, 300, move.lift_mm);
  move.seconds = number_or(table, "seconds", 0.1, 60, move.seconds);
  move.overshoot = number_or(table, "overshoot", 0, 1, move.overshoot);
  move.corrections = table.has("corrections") ? table.whole_number("corrections", 0, 10) : move.corrections;
  move.search_deg = number_or(table, "search_deg", 0, 60, move.search_deg);
  move.search_s = number_or(table, "search_s", 0, 60, move.search_s);
  move.rest_s = number_or(table, "rest_s", 0, 60, move.rest_s);
  move.doing = table.texts("do");
  move.pause_s = number_or(table, "pause_s", 0.1, 20, move.pause_s);
  return move;
}

struct StatusWord {
  const char* word;
  PoseStatus status;
};
constexpr std::array kStatusWords{
    StatusWord{"MISSING", PoseStatus::missing}, StatusWord{"OUT_OF_VIEW", PoseStatus::out_of_view},
    StatusWord{"OUT_OF_VOLUME", PoseStatus::out_of_volume}, StatusWord{"INVALID", PoseStatus::invalid}};

PlannedLoss read_loss(const TomlTable& table) {
  table.allow_only({"at_s", "for_s", "status"});
  PlannedLoss loss;
  loss.at_s = table.number("at_s", 0, 3600);
  loss.for_s = table.number("for_s", 0.01, 60);
  const std::string word = table.text("status");
  std::vector<std::string> known;
  for (const StatusWord& s : kStatusWords) {
    known.emplace_back(s.word);
    if (word == s.word) {
      loss.status = s.status;
      return loss;
    }
  }
  table.fail("status", "'" + word + "' is not a status of a lost probe", suggest(word, known));
}

}  // namespace

LogPlan read_log_plan(const std::filesystem::path& file) {
  const toml::table parsed = parse_toml(file.string(), read_file(file, 1 << 20));
  const TomlTable root(file.string(), "", parsed);
  root.allow_only({"scenario", "scenario_seed", "seed", "rate_hz", "press_mm", "unsteadiness_mm", "unsteadiness_deg",
                   "tremor_mm", "noise_mm", "noise_deg", "move", "loss"});
  LogPlan plan;
  plan.scenario = file.parent_path() / root.text("scenario");
  plan.scenario_seed = root.has("scenario_seed") ? std::uint32_t(root.whole_number("scenario_seed", 0, 2147483647)) : 0;
  plan.seed = std::uint32_t(root.whole_number("seed", 0, 2147483647));
  plan.rate_hz = number_or(root, "rate_hz", 10, 250, plan.rate_hz);
  plan.press_mm = number_or(root, "press_mm", 0, 20, plan.press_mm);
  plan.unsteadiness_mm = number_or(root, "unsteadiness_mm", 0, 20, plan.unsteadiness_mm);
  plan.unsteadiness_deg = number_or(root, "unsteadiness_deg", 0, 20, plan.unsteadiness_deg);
  plan.tremor_mm = number_or(root, "tremor_mm", 0, 5, plan.tremor_mm);
  plan.noise_mm = number_or(root, "noise_mm", 0, 5, plan.noise_mm);
  plan.noise_deg = number_or(root, "noise_deg", 0, 5, plan.noise_deg);
  for (const TomlTable& table : root.tables("move")) plan.moves.push_back(read_move(table));
  for (const TomlTable& table : root.tables("loss")) plan.losses.push_back(read_loss(table));
  if (plan.moves.size() < 2)
    root.fail("", "there are fewer than two moves",
              "add a [[move]] for where the log begins and one for where it goes");
  return plan;
}

}  // namespace insonate
