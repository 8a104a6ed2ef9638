#include "devices/log_report.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "devices/live/probe_buttons.h"

using namespace insonate;

namespace {

/// A hundred samples a second for ten seconds, 100 mm/s along x.
std::vector<ProbeSample> steady() {
  std::vector<ProbeSample> samples(1001);
  for (int i = 0; i <= 1000; ++i)
    samples[std::size_t(i)] = {1.7e9 + i / 100.0, PoseStatus::ok, Pose{glm::dmat3(1.0), {double(i), 0, 0}}, 0};
  return samples;
}

}  // namespace

TEST_CASE("the report of a steady log has its rate and path and nothing to complain of") {
  const LogReport report = check_log(steady());
  CHECK(report.frames == 1001);
  CHECK(report.usable == 1001);
  CHECK(report.begin_s == 1.7e9);
  CHECK(report.duration_s == Approx(10));
  // Times since 1970 are a quarter of a microsecond apart at best.
  CHECK(report.rate_hz() == Approx(100).epsilon(1e-4));
  CHECK(report.jitter_s < 1e-6);
  CHECK(report.path_mm == Approx(1000));
  CHECK(report.gaps.empty());
  CHECK(report.jumps.empty());
  CHECK(report.dropouts.empty());
  CHECK(report.findings().empty());
  CHECK(report.longest_step_s == Approx(0.01).epsilon(1e-4));
}

TEST_CASE("gaps, jumps and long dropouts are findings, short dropouts are none") {
  auto samples = steady();
  for (int i = 100; i < 120; ++i) samples[std::size_t(i)].status = PoseStatus::missing;
  CHECK(check_log(samples).findings().empty());
  for (int i = 300; i < 326; ++i) samples[std::size_t(i)].status = PoseStatus::out_of_view;
  for (std::size_t i = 700; i < samples.size(); ++i) samples[i].patient_from_probe.translation.y += 40;
  samples.erase(samples.begin() + 500, samples.begin() + 503);
  const LogReport report = check_log(samples);
  CHECK(report.findings() ==
        std::vector<std::string>{"1 gap in the samples, the longest step 40 ms.", "1 jump that no hand makes.",
                                 "A dropout (out of view) of 260 ms, in which the picture stands still."});
  CHECK(check_log({ProbeSample{5, PoseStatus::missing, {}, 0}}).findings().front() == "No frame is usable.");
}

TEST_CASE("jitter is the spread of the steps") {
  auto samples = steady();
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].time_s += i % 2 ? 0.001 : -0.001;
  // Steps of 12 and 8 ms in turn: the median is one of them, so that half of the steps differ by 4 ms.
  CHECK(check_log(samples).jitter_s == Approx(0.004 / std::sqrt(2)).epsilon(0.01));
}

TEST_CASE("missing samples are gaps, counted and placed") {
  auto samples = steady();
  samples.erase(samples.begin() + 500, samples.begin() + 503);
  samples.erase(samples.begin() + 200);
  const LogReport report = check_log(samples);
  REQUIRE(report.gaps.size() == 2);
  CHECK(report.gaps[0].frame == 200);
  CHECK(report.gaps[0].missing == 1);
  CHECK(report.gaps[1].frame == 499);
  CHECK(report.gaps[1].missing == 3);
  CHECK(report.gaps[1].length_s == Approx(0.04).epsilon(1e-4));
  CHECK(report.jumps.empty());
}

TEST_CASE("dropouts are counted by status and spell") {
  auto samples = steady();
  for (int i = 100; i < 120; ++i) samples[std::size_t(i)].status = PoseStatus::missing;
  for (int i = 120; i < 125; ++i) samples[std::size_t(i)].status = PoseStatus::out_of_view;
  for (int i = 990; i < 1001; ++i) samples[std::size_t(i)].status = PoseStatus::missing;
  const LogReport report = check_log(samples);
  CHECK(report.usable == 1001 - 36);
  REQUIRE(report.dropouts.size() == 2);
  CHECK(report.dropouts.at(PoseStatus::missing).frames == 31);
  CHECK(report.dropouts.at(PoseStatus::missing).spells == 2);
  CHECK(report.dropouts.at(PoseStatus::missing).longest_s == Approx(0.2).epsilon(1e-4));
  CHECK(report.dropouts.at(PoseStatus::out_of_view).frames == 5);
  // The way across a dropout is nobody's path: 25 samples are 26 steps, the last 11 as many.
  CHECK(report.path_mm == Approx(1000 - 26 - 11));
}

TEST_CASE("a jump is a step that no hand makes, in place or in turn") {
  auto samples = steady();
  for (std::size_t i = 300; i < samples.size(); ++i) samples[i].patient_from_probe.translation.y += 40;
  for (std::size_t i = 600; i < samples.size(); ++i)
    samples[i].patient_from_probe.rotation =
        glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(20.0), glm::dvec3(0, 1, 0)));
  // Noise of a millimetre at this rate is fast, but no jump.
  samples[800].patient_from_probe.translation.z += 9;
  const LogReport report = check_log(samples);
  REQUIRE(report.jumps.size() == 2);
  CHECK(report.jumps[0].frame == 300);
  CHECK(report.jumps[0].mm == Approx(std::hypot(40, 1)));
  CHECK(report.jumps[1].frame == 600);
  CHECK(report.jumps[1].deg == Approx(20));
}

TEST_CASE("marks are published, each once, also when tracking is lost while the button is held") {
  auto samples = steady();
  for (std::size_t i = 300; i < 340; ++i) samples[i].buttons = kEventMarkerButton | kFreezeButton;
  for (std::size_t i = 310; i < 320; ++i) samples[i] = {samples[i].time_s, PoseStatus::missing, Pose{}, 0};
  for (std::size_t i = 500; i < 510; ++i) samples[i].buttons = kEventMarkerButton;
  CHECK(check_log(samples).marks_s == std::vector{samples[300].time_s, samples[500].time_s});
}

TEST_CASE("a log of a single sample has a report without a rate") {
  const LogReport report = check_log({ProbeSample{5, PoseStatus::ok, {}, 0}});
  CHECK(report.frames == 1);
  CHECK(report.rate_hz() == 0);
  CHECK(report.duration_s == 0);
}
