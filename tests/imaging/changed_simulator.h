#pragma once

#include <catch2/catch.hpp>

#include <array>
#include <functional>
#include <span>
#include <string>

#include "sim/imaging/simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/test_body.h"

namespace insonate::test {

/// Gives a simulator the test body, and a curvilinear probe on its skin.
inline void set_up(gl::Simulator& simulator, const Settings& settings) {
  simulator.set_volume(test_body(), tissues());
  simulator.set_probe(*find_probe("curvilinear"), 100);
  simulator.set_settings(exact_as_needed(settings));
  simulator.set_pose(on_the_skin(0, 9, 0));
}

/// Returns the numbers of the stages that ran more often than before.
template <std::size_t Count>
std::string stages_run(const std::array<long, Count>& before, const std::array<long, Count>& now) {
  std::string ran;
  for (std::size_t stage = 0; stage < Count; ++stage)
    if (now[stage] > before[stage]) ran += char('0' + stage);
  return ran;
}

/// A simulator that has drawn its first picture, and the settings that a test changes.
struct ChangedSimulator {
  TestContext context;
  gl::Simulator simulator;
  Settings settings;

  explicit ChangedSimulator(const Settings& first) : settings(exact_as_needed(first)) {
    set_up(simulator, settings);
    simulator.image();
  }

  /// Returns the numbers of the stages that run after a change.
  std::string after(const std::function<void()>& change) {
    const auto before = simulator.runs();
    change();
    simulator.set_settings(settings);
    simulator.image();
    return stages_run(before, simulator.runs());
  }

  /// Checks that the picture after each change is the picture that a new simulator draws.
  void compare_with_new(std::span<const std::function<void(Settings&)>> changes) {
    for (std::size_t i = 0; i < changes.size(); ++i) {
      INFO("change " << i);
      changes[i](settings);
      simulator.set_settings(settings);
      gl::Simulator fresh;
      set_up(fresh, settings);
      CHECK((simulator.read_stages().grey.pixels == fresh.read_stages().grey.pixels));
      CHECK((simulator.read_stages().fused.pixels == fresh.read_stages().fused.pixels));
    }
  }
};

}  // namespace insonate::test
