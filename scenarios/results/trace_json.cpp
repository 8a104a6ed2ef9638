#include "scenarios/results/trace_json.h"

#include <nlohmann/json.hpp>

#include <array>
#include <stdexcept>

#include "scenarios/json_problem.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int kFormat = 1;
constexpr std::array kFace{"face_x_mm", "face_y_mm", "face_z_mm"};

/// Lists each quantity once, for both writing and reading. Calls `visit` with its key, whether it is defined for
/// invalid points, and a function that returns the field.
template <typename Visit>
void each_list(Visit&& visit) {
  visit(
      "time_s", true, [](auto& p) -> auto& { return p.time_s; });
  visit(
      "step", true, [](auto& p) -> auto& { return p.step; });
  visit(
      "valid", true, [](auto& p) -> auto& { return p.valid; });
  visit(
      "on_skin", true, [](auto& p) -> auto& { return p.on_skin; });
  visit(
      "within_tolerance", true, [](auto& p) -> auto& { return p.within_tolerance; });
  visit(
      "speed_mm_s", true, [](auto& p) -> auto& { return p.speed_mm_s; });
  for (int axis = 0; axis < 3; ++axis)
    visit(
        kFace[std::size_t(axis)], false, [axis](auto& p) -> auto& { return p.face[axis]; });
  for (const ViewValues::Field& field : ViewValues::fields())
    visit(
        std::string(info(field.metric).name).c_str(), false, [field](auto& p) -> auto& { return p.view.*field.value; });
}

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw InputError(name, "", "this is not a trace of Insonate: " + why, "score the log again");
}

}  // namespace

std::string to_json(std::span<const TracePoint> trace) {
  OrderedJson json = {{"format", kFormat}, {"points", trace.size()}};
  each_list([&](const char* key, bool always, auto&& field) {
    OrderedJson& list = json[key] = OrderedJson::array();
    for (const TracePoint& point : trace)
      list.push_back(always || point.valid ? OrderedJson(field(point)) : OrderedJson(nullptr));
  });
  return json.dump() + "\n";
}

std::vector<TracePoint> trace_from_json(std::string_view text, const std::string& name) {
  try {
    const OrderedJson json = OrderedJson::parse(text);
    if (json.at("format") != kFormat) throw std::runtime_error("a format that this program does not read");
    std::vector<TracePoint> trace(json.at("time_s").size());
    each_list([&](const char* key, bool, auto&& field) {
      const OrderedJson& list = json.at(key);
      if (!list.is_array() || list.size() != trace.size()) throw std::runtime_error("lists of different lengths");
      for (std::size_t i = 0; i < trace.size(); ++i)
        if (!list[i].is_null()) read_value(list[i], field(trace[i]));
    });
    return trace;
  } catch (const OrderedJson::exception& error) {
    refuse(name, json_problem(error, text));
  } catch (const std::runtime_error& error) {
    refuse(name, error.what());
  }
}

}  // namespace insonate
