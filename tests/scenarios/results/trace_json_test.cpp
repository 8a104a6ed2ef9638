#include "scenarios/results/trace_json.h"

#include <catch2/catch.hpp>

#include <limits>

#include "sim/core/input_error.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

TEST_CASE("a trace goes to JSON and back without losing a bit") {
  std::vector<TracePoint> trace = tiny_exam(1.0 / 3).trace;
  REQUIRE(trace.size() > 10);
  trace[3].face = {-0.0, 1e-310, 0.1 + 0.2};
  trace[4].valid = false;
  trace[4].face = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
  const std::vector<TracePoint> back = trace_from_json(to_json(trace), "x");
  REQUIRE(back.size() == trace.size());
  for (std::size_t i = 0; i < trace.size(); ++i) {
    CHECK(back[i].time_s == trace[i].time_s);
    CHECK(back[i].step == trace[i].step);
    CHECK(back[i].valid == trace[i].valid);
    CHECK(back[i].on_skin == trace[i].on_skin);
    CHECK(back[i].within_tolerance == trace[i].within_tolerance);
    CHECK(back[i].speed_mm_s == trace[i].speed_mm_s);
    CHECK(back[i].face == (trace[i].valid ? trace[i].face : glm::dvec3(0.0)));
    for (const auto& [metric, value] : ViewValues::fields())
      CHECK(back[i].view.*value == (trace[i].valid ? trace[i].view : ViewValues{}).*value);
  }
  CHECK(to_json(back) == to_json(trace));
  CHECK(trace_from_json(to_json(std::span<const TracePoint>{}), "x").empty());
}

TEST_CASE("JSON that is not a trace is refused") {
  const std::string json = to_json(tiny_exam(1).trace);
  CHECK_THROWS_AS(trace_from_json("", "x"), InputError);
  CHECK_THROWS_AS(trace_from_json("[]", "x"), InputError);
  CHECK_THROWS_WITH(trace_from_json("{\n\"", "x"),
                    "x: this is not a trace of Insonate: line 2 is not JSON; score the log again.");
  CHECK_THROWS_WITH(trace_from_json("{}", "x"),
                    "x: this is not a trace of Insonate: key 'format' not found; score the log again.");
  const auto spoiled = [&](const std::string& from, const std::string& to) {
    std::string text = json;
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
    CHECK_THROWS_AS(trace_from_json(text, "x"), InputError);
  };
  spoiled("\"format\":1", "\"format\":2");
  spoiled("\"valid\":[true,", "\"valid\":[");
  spoiled("\"valid\":[true,", "\"valid\":[\"yes\",");
  spoiled("\"face_y_mm\"", "\"face_b_mm\"");
  spoiled("\"step\":[0,", "\"step\":{},\"x\":[0,");
  for (const char* step : {"-5.0", "-5", "0.5", "1e300", "18446744073709551616"})
    spoiled("\"step\":[0,", "\"step\":[" + std::string(step) + ",");
}
