#include "scenarios/action.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include "devices/record/sequence_recorder.h"
#include "devices/sequence/probe_samples.h"
#include "scenarios/result_json.h"
#include "scenarios/runner.h"
#include "sim/core/hash.h"
#include "tests/core/temporary_folder.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

std::vector<Action> one_of_each() {
  return {{ActionKind::probe, {}, "linear"},
          {ActionKind::depth, {120.1}},
          {ActionKind::frequency, {3.5}},
          {ActionKind::gain, {-6}},
          {ActionKind::dynamic_range, {45.5}},
          {ActionKind::time_gain, {8, -12.25}},
          {ActionKind::effect, {0}, "mirror_image"},
          {ActionKind::effect, {62.5}, "focus_mm"},
          {ActionKind::effect, {0}, ""},
          {ActionKind::freeze},
          {ActionKind::unfreeze},
          {ActionKind::caliper, {2, -10.123456789012345, 40, 1.0 / 3, 41}},
          {ActionKind::ellipse, {1, -10, 40, 10, 40, 7.25}},
          {ActionKind::point, {1e-9, 80}},
          {ActionKind::label, {3, 4}, "liver"},
          {ActionKind::take_back, {2}},
          {ActionKind::take_back, {0}, "liver"},
          {ActionKind::answer, {}, "50 % sure; \xc3\xa9\n"},
          {ActionKind::answer, {}, ""},
          {ActionKind::hint},
          {ActionKind::go_to, {}, "aorta"},
          {ActionKind::guide, {1}},
          {ActionKind::patient, {}, "Abdomen phantom, aorta_diameter_mm 45"},
          {ActionKind::go_on}};
}

std::string refusal(const std::string& text) {
  try {
    parse_actions(text, "scan.igs.mha", "frame 7");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("actions are read back from a log's text to the bit, whatever a learner types") {
  const std::vector<Action> actions = one_of_each();
  const std::string text = to_text(actions);
  CHECK(parse_actions(text, "f", "p") == actions);
  for (const char c : text) CHECK((c >= ' ' && c < 0x7f));

  const std::vector<Action> longer{{ActionKind::answer, {}, std::string(1000, 'x')}};
  CHECK(parse_actions(to_text(longer), "f", "p")[0].text.size() == Action::kLongestText);
  CHECK(parse_actions("", "f", "p").empty());
}

TEST_CASE("a mistake in a log's actions is refused in words") {
  CHECK(refusal("freeez").find("scan.igs.mha: frame 7: there is no action 'freeez'; did you mean 'freeze'?") == 0);
  CHECK(refusal("depth").find("'depth' is followed by 0 words instead of 1") != std::string::npos);
  CHECK(refusal("depth 12 13").find("2 words instead of 1") != std::string::npos);
  for (const char* bad : {"depth deep", "depth 1e7", "depth nan", "depth inf", "depth 1x"})
    CHECK(refusal(bad).find("is not a number from -1,000,000") != std::string::npos);
  for (const char* bad : {"caliper 0 1 2 3 4", "caliper 1.5 1 2 3 4", "ellipse 10 1 2 3 4 5"})
    CHECK(refusal(bad).find("a slot is not a whole number from 1 to 9") != std::string::npos);
  for (const char* bad : {"time_gain 0 3", "time_gain 9 3", "time_gain 1.5 3"})
    CHECK(refusal(bad).find("a slider is not a whole number from 1 to 8") != std::string::npos);
  CHECK(refusal("guide 2").find("a guide is not a whole number from 0 to 1") != std::string::npos);
  CHECK(refusal("effect 0 :mirror_imag").find("there is no effect 'mirror_imag'; did you mean 'mirror_image'?") !=
        std::string::npos);
  for (const char* bad : {"effect 2 :waves", "effect 0.5 :waves", "effect -1 :waves"})
    CHECK(refusal(bad).find("'waves' has a value that is not a whole number from 0 to 1") != std::string::npos);
  CHECK(refusal("effect 9 :focus_mm").find("not a number from 10 to 240") != std::string::npos);
  CHECK(refusal("answer yes").find("begin with ':'") != std::string::npos);
  for (const char* bad : {"answer :50%", "answer :50%4", "answer :%zz"})
    CHECK(refusal(bad).find("hexadecimal") != std::string::npos);
  CHECK(refusal("answer :" + std::string(241, 'x')).find("240 bytes") != std::string::npos);
}

TEST_CASE("whatever a log's actions hold, they are read or refused in words") {
  const std::string whole = to_text(one_of_each());
  int refused = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    std::string text = whole.substr(0, hash(3, i) % (whole.size() + 1));
    for (std::uint32_t k = 0; k < 1 + hash(4, i) % 3 && !text.empty(); ++k)
      text[hash(5, i, k, 0) % text.size()] = char(hash(6, i, k, 0));
    try {
      parse_actions(text, "f", "p");
    } catch (const InputError&) {
      ++refused;
    }
  }
  CHECK(refused > 1000);
}

TEST_CASE("a log that keeps the learner's actions gets the live run's score to the bit") {
  const Case subject = tiny_case();
  const Scenario scenario = parse_scenario(kTinyScenario, "exam.toml");
  const TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path;
  const auto samples = samples_of(8, 40, [](double t) {
    return turned(3 * std::sin(t), {1, 0, 0}, {0, 0, std::max(3.0, 40 - 12 * t)});
  });

  Runner live(scenario, subject, tiny_tissues());
  {
    SequenceRecorder recorder(folder / "scan.igs.mha");
    for (std::size_t i = 0; i < samples.size(); ++i) {
      std::vector<Action> before;
      if (i == 10) before = one_of_each();
      if (i == 10) before.pop_back();
      if (i == 100) before = {{ActionKind::go_on}};
      live.feed(samples[i], before);
      recorder.add(samples[i], to_text(before));
    }
    recorder.finish();
  }
  live.end();
  const RecordedScan scan = read_recorded_scan(folder / "scan.igs.mha");
  CHECK(scan.recording.actions.size() == 2);
  Runner replayed(scenario, subject, tiny_tissues());
  replayed.feed(scan.samples, parse_action_log(scan.recording.actions, "scan.igs.mha"));
  replayed.end();
  CHECK(to_json(replayed.result()) == to_json(live.result()));
  // The action counted: the first step ended with it, at 2.5 s, and the second one went on.
  CHECK(live.result().steps[0].outcome == StepOutcome::went_on);
  CHECK(live.result().steps[0].end_s == 2.5);
  CHECK(live.result().steps[1].outcome == StepOutcome::held);
  CHECK(replayed.machine().depth_mm == 120.1);
  CHECK(replayed.machine().probe == "linear");
}

TEST_CASE("actions of a sample that is passed over are done with the next one") {
  const Case subject = tiny_case();
  Runner runner(parse_scenario(kTinyScenario, "exam.toml"), subject, tiny_tissues());
  const std::vector<Action> deeper{{ActionKind::depth, {99}}};
  runner.feed(sample_at(1, Pose{}), {});
  runner.feed(sample_at(1, Pose{}), deeper);
  CHECK(runner.machine().depth_mm == 140);
  runner.feed(sample_at(1.1, Pose{}));
  CHECK(runner.machine().depth_mm == 99);
}

TEST_CASE("a picture freezes at the last valid sample before the action") {
  const Case subject = tiny_case();
  Runner runner(parse_scenario(kTinyScenario, "exam.toml"), subject, tiny_tissues());
  const Pose first = turned(0, {1, 0, 0}, {0, 0, 30}), second = turned(0, {1, 0, 0}, {0, 0, 31});
  const std::vector<Action> freeze{{ActionKind::freeze}}, unfreeze{{ActionKind::unfreeze}};
  runner.feed(sample_at(0, first));
  runner.feed(sample_at(0.1, second, PoseStatus::missing));
  runner.feed(sample_at(0.2, second), freeze);
  REQUIRE(runner.machine().frozen_at);
  CHECK(*runner.machine().frozen_at == first);
  runner.feed(sample_at(0.3, second), freeze);  // frozen already
  CHECK(*runner.machine().frozen_at == first);
  runner.feed(sample_at(0.4, second), unfreeze);
  CHECK_FALSE(runner.machine().frozen_at);
}
