// The ultrasound machine: what actions make of it, and the actions that lead from one to another.
#include "scenarios/machine.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("the actions between two machines bring the knobs of one to those of the other") {
  Machine from, to;
  from.choose("curvilinear");
  to.choose("linear");
  to.depth_mm = 55;
  to.frequency_mhz = 9;
  to.gain_db = -4;
  to.dynamic_range_db = 45;
  to.time_gain_db = {1, 0, -2, 0, 3, 0, 0, 20};
  to.effects = {{"mirror_image", 0}, {"focus_mm", 55}};
  from.effects = {{"waves", 0}, {"focus_mm", 30}};
  to.frozen = true;
  for (const Machine& untouched : {from, Machine()}) {
    Machine machine = untouched;
    for (const Action& action : actions_between(untouched, to)) machine.apply(action, std::nullopt);
    CHECK(machine == to);
  }
  INFO("a frozen picture is let go before what it would refuse");
  for (const Action& action : actions_between(to, from)) to.apply(action, std::nullopt);
  CHECK(to == from);
  CHECK(actions_between(from, from).empty());
}

TEST_CASE("a machine limits what an action asks for, and knows its own probes alone") {
  Machine machine;
  CHECK_THROWS_AS(machine.transducer(), std::logic_error);
  machine.choose("curvilinear");
  CHECK(machine.transducer().name == "curvilinear");
  const auto set = [&](ActionKind kind, double value) { machine.apply({kind, {value}}, std::nullopt); };
  set(ActionKind::depth, 1e6);
  CHECK(machine.depth_mm == Machine::kMaxDepth_mm);
  set(ActionKind::dynamic_range, 0);
  CHECK(machine.dynamic_range_db == Machine::kMinDynamicRange_db);
  set(ActionKind::dynamic_range, 1e6);
  CHECK(machine.dynamic_range_db == Machine::kMaxDynamicRange_db);
  machine.apply({ActionKind::time_gain, {8, -1e6}}, std::nullopt);
  CHECK(machine.time_gain_db[7] == -Machine::kMaxTimeGain_db);
  machine.apply({ActionKind::effect, {1e6}, "focus_mm"}, std::nullopt);
  CHECK(machine.effects == std::map<std::string, double>{{"focus_mm", 240}});
  const Machine before = machine;
  machine.apply({ActionKind::effect, {1}, "none"}, std::nullopt);
  machine.apply({ActionKind::probe, {}, "none"}, std::nullopt);
  CHECK(machine == before);
}

TEST_CASE("a frozen picture follows what acts on acquired echoes, and nothing that acquires others") {
  Machine machine;
  machine.choose("curvilinear");
  const Pose at{glm::dmat3(1.0), {1, 2, 3}};
  machine.apply({ActionKind::freeze}, at);
  const Machine frozen = machine;
  for (const Action& action : {Action{ActionKind::probe, {}, "linear"},
                               {ActionKind::depth, {55}},
                               {ActionKind::frequency, {9}},
                               {ActionKind::effect, {0}, "waves"}}) {
    CAPTURE(word_of(action.kind));
    CHECK(machine.refuses(action.kind));
    machine.apply(action, at);
    CHECK(machine == frozen);
  }
  for (const Action& action :
       {Action{ActionKind::gain, {7}}, {ActionKind::dynamic_range, {45}}, {ActionKind::time_gain, {3, 5}}}) {
    CAPTURE(word_of(action.kind));
    CHECK_FALSE(machine.refuses(action.kind));
    const Machine before = machine;
    machine.apply(action, at);
    CHECK_FALSE(machine == before);
  }
  CHECK(machine.frozen_at == at);
  machine.apply({ActionKind::unfreeze}, at);
  machine.apply({ActionKind::depth, {55}}, at);
  CHECK(machine.depth_mm == 55);
}
