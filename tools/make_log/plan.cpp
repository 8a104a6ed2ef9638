#include "tools/make_log/plan.h"

#include <array>

#include "sim/files/files.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

PlannedMove read_move(const TomlTable& table) {
  PlannedMove move;
  move.view = table.text("view");
  move.lateral_mm = table.number("lateral_mm", {-300, 300}, move.lateral_mm);
  move.elevation_mm = table.number("elevation_mm", {-300, 300}, move.elevation_mm);
  move.tilt_deg = table.number("tilt_deg", {-90, 90}, move.tilt_deg);
  move.rock_deg = table.number("rock_deg", {-90, 90}, move.rock_deg);
  move.rotation_deg = table.number("rotation_deg", {-180, 180}, move.rotation_deg);
  move.lift_mm = table.number("lift_mm", {0, 300}, move.lift_mm);
  move.seconds = table.number("seconds", {0.1, 60}, move.seconds);
  move.overshoot = table.number("overshoot", {0, 1}, move.overshoot);
  move.corrections = int(table.whole_number("corrections", 0, 10, move.corrections));
  move.search_deg = table.number("search_deg", {0, 60}, move.search_deg);
  move.search_s = table.number("search_s", {0, 60}, move.search_s);
  move.rest_s = table.number("rest_s", {0, 60}, move.rest_s);
  move.doing = table.texts("do");
  move.pause_s = table.number("pause_s", {0.1, 20}, move.pause_s);
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
  PlannedLoss loss;
  loss.at_s = table.number("at_s", {0, 3600});
  loss.for_s = table.number("for_s", {0.01, 60});
  std::vector<std::string> words;
  for (const StatusWord& status : kStatusWords) words.emplace_back(status.word);
  loss.status = kStatusWords[table.choice("status", words)].status;
  return loss;
}

}  // namespace

LogPlan read_log_plan(const std::filesystem::path& file) {
  const TomlDocument document(file.string(), read_file(file, 1 << 20));
  const TomlTable root = document.root();
  LogPlan plan;
  plan.scenario = file.parent_path() / root.text("scenario");
  plan.scenario_seed = std::uint32_t(root.whole_number("scenario_seed", 0, 2147483647, 0));
  plan.seed = std::uint32_t(root.whole_number("seed", 0, 2147483647));
  plan.rate_hz = root.number("rate_hz", {10, 250}, plan.rate_hz);
  plan.press_mm = root.number("press_mm", {0, 20}, plan.press_mm);
  plan.unsteadiness_mm = root.number("unsteadiness_mm", {0, 20}, plan.unsteadiness_mm);
  plan.unsteadiness_deg = root.number("unsteadiness_deg", {0, 20}, plan.unsteadiness_deg);
  plan.tremor_mm = root.number("tremor_mm", {0, 5}, plan.tremor_mm);
  plan.noise_mm = root.number("noise_mm", {0, 5}, plan.noise_mm);
  plan.noise_deg = root.number("noise_deg", {0, 5}, plan.noise_deg);
  for (const TomlTable& table : root.tables("move")) plan.moves.push_back(read_move(table));
  for (const TomlTable& table : root.tables("loss")) plan.losses.push_back(read_loss(table));
  root.refuse_unknown_keys();
  if (plan.moves.size() < 2)
    root.fail("", "there are fewer than two moves",
              "add a [[move]] for where the log begins and one for where it goes");
  return plan;
}

}  // namespace insonate
