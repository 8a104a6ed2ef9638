#pragma once

#include <functional>
#include <string>

#include "scenarios/runner.h"
#include "tests/scenarios/tiny_case.h"

namespace insonate {

// Exams with any kind of step over the tiny case, and the actions of a learner in them.

inline const Case& shared_case() {
  static const Case subject = tiny_case();
  return subject;
}

inline Scenario exam_of(const std::string& steps, const std::string& head = "", std::uint32_t seed = 0) {
  return parse_scenario(
      "format = 2\ntitle = \"Kinds\"\ncase = \"tiny\"\npass_mark_percent = 50\ntime_limit_s = 60\n" + head + steps,
      "exam.toml", seed);
}

inline std::string step(const std::string& kind, const std::string& keys, const std::string& metric = "",
                        const std::string& full_zero = "full = 100\nzero = 0") {
  return "[[step]]\nkind = \"" + kind + "\"\ntitle = \"A step\"\ninstruction = \"Do it.\"\n" + keys + "\n" +
         (metric.empty() ? "" : "[[step.criterion]]\nmetric = \"" + metric + "\"\n" + full_zero + "\n");
}

inline Pose at_z(double z) {
  return {glm::dmat3(1.0), {0, 0, z}};
}

/// Returns the score of a scan. The actions belong to the samples of their times.
inline ExamResult scored(const Scenario& scenario, std::span<const ProbeSample> samples, const ActionLog& actions,
                         const Case& subject = shared_case()) {
  Runner runner(scenario, subject, tiny_tissues());
  runner.feed(samples, actions);
  runner.end();
  return runner.result();
}

/// Does the same with ten samples per second.
inline ExamResult scored(
    const Scenario& scenario, double duration_s, const ActionLog& actions,
    const std::function<Pose(double)>& pose = [](double) { return at_z(0); }) {
  return scored(scenario, samples_of(duration_s, 10, pose), actions);
}

inline const Action kFreeze{ActionKind::freeze};
inline const Action kGoOn{ActionKind::go_on};

inline Action caliper(int slot, double x1, double y1, double x2, double y2) {
  return {ActionKind::caliper, {double(slot), x1, y1, x2, y2}};
}
inline Action answer(const std::string& text) {
  return {ActionKind::answer, {}, text};
}

}  // namespace insonate
