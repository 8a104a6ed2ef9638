// A recorded exam, sent by a mocked tracker on USB as it would have come from the sensor, scores as its log does.
#include "scripted_bus.h"
#include <catch2/catch.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstring>

#include "devices/polhemus/polhemus_tracker.h"
#include "devices/sequence/probe_samples.h"
#include "scenarios/runner.h"
#include "sim/files/files.h"
#include "tests/devices/golden_reports.h"

using namespace insonate;

namespace {

const std::filesystem::path kAssets = INSONATE_ASSETS_FOLDER;

/// The sample as a Liberty puts it into its record: centimetres and a quaternion, in single precision, and an error
/// instead of the blank where it has no pose.
ScriptedBus::Report liberty_record(std::uint32_t frame, const ProbeSample& sample) {
  ScriptedBus::Report record(std::begin(golden::kLiberty), std::end(golden::kLiberty));
  const auto put = [&](std::size_t at, auto value) { std::memcpy(&record[at], &value, sizeof value); };
  put(12, frame);
  if (sample.status != PoseStatus::ok) {
    put(4, 'u');
    return record;
  }
  const glm::dvec3 place = sample.patient_from_probe.translation / 10.0;
  const glm::dquat q = glm::quat_cast(sample.patient_from_probe.rotation);
  std::size_t at = 20;
  for (const double value : {place.x, place.y, place.z, q.w, q.x, q.y, q.z}) {
    put(at, float(value));
    at += sizeof(float);
  }
  return record;
}

/// What comes of a log when a Liberty sends it, record by record at the log's times.
std::vector<ProbeSample> through_liberty(const std::vector<ProbeSample>& log) {
  const auto bus = std::make_shared<ScriptedBus>();
  bus->attached.devices = {{0x0f44, 0xff20, "", "L2", "bus 1, address 5", -1}};
  double now_s = log.front().time_s;
  PolhemusSource source(bus, "L2", 1, Placement({}, true), [&] { return now_s; });
  source.open();
  LiveBatch batch;
  std::uint32_t frame = 0;
  for (const ProbeSample& sample : log) {
    now_s = sample.time_s;
    bus->reports.push_back(liberty_record(++frame, sample));
    source.read(std::chrono::milliseconds(20), batch);
  }
  source.close();
  return batch.samples;
}

struct Exam {
  Scenario scenario = read_scenario(kAssets / "scenarios" / "ruq_hepatorenal.toml");
  Case subject = load_case(coarse(scenario), kAssets, cache_folder());
  TissueTable tissues = read_tissue_table(kAssets / "tissues.toml");

  // Voxels of 2 mm are made in seconds, and both ways meet the same ones.
  static const Scenario& coarse(Scenario& scenario) {
    scenario.phantom_options.emplace_back("voxel_mm", "2");
    return scenario;
  }
  ExamResult score(const std::vector<ProbeSample>& samples) const {
    Runner runner(scenario, subject, tissues);
    runner.feed(samples);
    runner.end();
    return runner.result();
  }
};

/// Single precision leaves 1e-5 mm and 1e-5 degrees of a pose. A metric that counts pixels or voxels may gain or lose
/// one of some thousands by that; what is a count of movements or losses may not change at all.
void check_same(const std::vector<CriterionScore>& sent, const std::vector<CriterionScore>& logged) {
  REQUIRE(sent.size() == logged.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    CAPTURE(sent[i].why, logged[i].why);
    REQUIRE(sent[i].value.has_value() == logged[i].value.has_value());
    if (sent[i].value) CHECK(*sent[i].value == Approx(*logged[i].value).epsilon(1e-3));
    CHECK(sent[i].points == Approx(logged[i].points).margin(1e-3));
  }
}

}  // namespace

TEST_CASE("a recorded exam that a mocked USB tracker sends scores as its log does") {
  const Exam exam;
  for (const char* name : {"ruq_good.igs.mha", "ruq_poor.igs.mha"}) {
    CAPTURE(name);
    const std::vector<ProbeSample> log = read_recorded_scan(kAssets / "logs" / name).samples;
    const std::vector<ProbeSample> samples = through_liberty(log);
    CHECK(samples.size() == log.size());
    const ExamResult logged = exam.score(log), sent = exam.score(samples);
    CHECK(sent.passed == logged.passed);
    CHECK(sent.percent == Approx(logged.percent).margin(0.01));
    CHECK(sent.motion.dropouts == logged.motion.dropouts);
    CHECK(sent.motion.rotational_movements == logged.motion.rotational_movements);
    CHECK(sent.motion.translational_movements == logged.motion.translational_movements);
    REQUIRE(sent.steps.size() == logged.steps.size());
    for (std::size_t i = 0; i < sent.steps.size(); ++i) {
      CHECK(sent.steps[i].outcome == logged.steps[i].outcome);
      check_same(sent.steps[i].criteria, logged.steps[i].criteria);
    }
    check_same(sent.criteria, logged.criteria);
  }
}
