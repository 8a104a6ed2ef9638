#include "test_samples.h"
#include <catch2/catch.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <filesystem>
#include <map>

#include "devices/live/live_tracker.h"
#include "devices/live/steady_clock.h"
#include "devices/mouse/mouse_tracker.h"
#include "devices/registry.h"
#include "devices/sequence/probe_samples.h"
#include "devices/synthetic/synthetic_tracker.h"
#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"

using namespace insonate;

namespace {

std::string refusal(const std::string& uri) {
  try {
    open_tracker(uri);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

const std::string kLog = std::string(INSONATE_SEQUENCES_FOLDER) + "/plus_images.igs.mha";

}  // namespace

TEST_CASE("a URI is taken apart into kind, subject and options") {
  const TrackerUri plain = parse_tracker_uri("mouse:");
  CHECK(plain.scheme == "mouse");
  CHECK(plain.subject.empty());
  const TrackerUri full = parse_tracker_uri("replay:/scans/what?now: then.igs.mha?speed=0.5&loop=1");
  CHECK(full.subject == "/scans/what?now: then.igs.mha");
  CHECK(full.options == std::map<std::string, std::string>{{"speed", "0.5"}, {"loop", "1"}});
  CHECK(full.number("speed", 1, 0, 10) == 0.5);
  CHECK(full.flag("loop", false));
  CHECK(full.number("rate", 60, 1, 1000) == 60);
}

TEST_CASE("a tracker that cannot be opened is refused with what to write instead") {
  const std::vector<std::pair<std::string, std::vector<std::string>>> refused = {
      {"", {"no kind before a colon", "'replay:scan.igs.mha'"}},
      {":x", {"no kind before a colon"}},
      {"mouse", {"no kind before a colon"}},
      {"replai:x", {"no kind of tracker 'replai'", "did you mean 'replay'?"}},
      {"zzzzzz:x", {"use one of 'replay', 'raw', 'synthetic', 'rehearsal', 'auto', 'polhemus'"}},
      {kLog, {"did you mean 'replay:"}},
      {"replay:", {"names no file"}},
      {"replay:/nowhere/scan.igs.mha", {"/nowhere/scan.igs.mha", "no such file"}},
      {"replay:" + kLog + "?speed", {"option 'speed'", "name=value"}},
      {"replay:" + kLog + "?speed=", {"name=value"}},
      {"replay:" + kLog + "?speed=fast", {"option 'speed'", "'fast' is not a number from 0.01 to 1000"}},
      {"replay:" + kLog + "?speed=0", {"'0' is not a number from 0.01 to 1000"}},
      {"replay:" + kLog + "?speed=nan", {"'nan' is not a number"}},
      {"replay:" + kLog + "?speed=2x", {"'2x' is not a number"}},
      {"replay:" + kLog + "?loop=yes", {"'yes' is neither 0 nor 1"}},
      {"replay:" + kLog + "?speed=2&speed=3", {"option 'speed'", "twice"}},
      {"replay:" + kLog + "?spead=2", {"option 'spead'", "did you mean 'speed'?"}},
      {"replay:" + kLog + "?transform=ProbeToTraker", {"'ProbeToTraker'", "did you mean 'ProbeToTracker'?"}},
      {"synthetic:x", {"seed 'x'"}},
      {"rehearsal:lab", {"needs no name", "'rehearsal:'"}},
      {"rehearsal:?raw=2", {"'2' is neither 0 nor 1"}},
      {"synthetic:4294967296", {"seed '4294967296'"}},
      {"synthetic:1?rate=0", {"from 1 to 1000"}},
      {"igtl:localhost", {"no '//' before the host", "'igtl://localhost:18944/ProbeToTracker'"}},
      {"igtl://", {"names no host"}},
      {"igtl://:18944", {"names no host"}},
      {"igtl://two words:18944", {"has no spaces"}},
      {"igtl://host:", {"':' is not a port from 1 to 65535"}},
      {"igtl://host:0", {"':0' is not a port"}},
      {"igtl://host:65536", {"':65536' is not a port"}},
      {"igtl://host:1x", {"':1x' is not a port"}},
      {"igtl://[::1", {"bracket of the host is not closed"}},
      {"igtl://[::1]18944", {"'18944' is not a port"}},
      {"igtl://" + std::string(254, 'h'), {"a host's name has 253 characters at most"}},
      {"igtl://host/AVeryLongNameOfATransform", {"20 characters"}},
      {"igtl://host?frame=abc", {"option 'frame'", "'abc' is neither 'lps' nor 'ras'"}},
      {"igtl://host?speed=1", {"option 'speed'"}},
      {"mouse:x", {"needs no name"}},
      {"mouse:?rate=1", {"option 'rate'", "has no options"}},
  };
  for (const auto& [uri, expected] : refused) {
    const std::string sentence = refusal(uri);
    CAPTURE(uri, sentence);
    REQUIRE_FALSE(sentence.empty());
    for (const std::string& words : expected) CHECK(sentence.find(words) != std::string::npos);
  }
}

TEST_CASE("whatever is typed as a tracker is opened or refused in a sentence") {
  const std::string letters = "replaysynthticmou:?&=.0123456789-+/ \t%";
  int refused = 0;
  for (std::uint32_t trial = 0; trial < 5000; ++trial) {
    std::string uri = std::string(trial % 2 ? "synthetic:" : "") + (trial % 4 == 3 ? "1?rate=" : "");
    for (std::uint32_t i = 0; i < hash(trial, 0) % 12; ++i) uri += letters[hash(trial, i + 1) % letters.size()];
    try {
      open_tracker(uri);
    } catch (const InputError&) {
      ++refused;
    }
  }
  CHECK(refused > 4000);
}

TEST_CASE("every kind of tracker opens by the registry, and its form begins with its name") {
  for (const TrackerKind& kind : tracker_kinds()) CHECK(kind.form.starts_with(std::string(kind.scheme) + ":"));
  const auto replay = open_tracker("replay:" + kLog + "?speed=2&loop=0&transform=ReferenceToTracker");
  std::vector<ProbeSample> samples;
  replay->poll(0, samples);
  CHECK(samples.size() == 1);
  replay->poll(0.11, samples);
  CHECK(same_bits(samples, read_recorded_scan(kLog, {.transform = "ReferenceToTracker"}).samples));
  CHECK(replay->state().name == "replay of plus_images.igs.mha");
  REQUIRE(replay->recording());
  CHECK(replay->recording()->file == "plus_images.igs.mha");
  CHECK(replay->recording()->digest == digest_of(read_file(kLog)));
  CHECK(replay->recording()->transform == "ReferenceToTracker");
  CHECK_FALSE(replay->repeats());
  CHECK(open_tracker("replay:" + kLog + "?loop=1")->repeats());
  CHECK(open_tracker("replay:" + kLog)->recording()->transform == "ProbeToTracker, TrackerToReference");
  CHECK(open_tracker("mouse:")->recording() == nullptr);
  CHECK_NOTHROW(open_tracker("mouse:"));
  CHECK_NOTHROW(open_tracker("synthetic:"));
}

TEST_CASE("a tracker's state reports rate, status and loss on the tracker's own clock") {
  SyntheticTracker hand(1, 100, {});
  CHECK(hand.state().condition == TrackerCondition::waiting);
  CHECK(hand.state().rate_hz == 0);
  const auto samples = poll_until(hand, 0.9, 30);
  CHECK(hand.state().condition == TrackerCondition::tracking);
  CHECK(hand.state().rate_hz == Approx(100));
  CHECK(hand.state().delivered == samples.size());
  CHECK(hand.state().last_status == samples.back().status);

  // A log whose second half is lost: at twice the speed it is lost after half a second more.
  std::vector<ProbeSample> log(300);
  for (int i = 0; i < 300; ++i)
    log[std::size_t(i)] = {50 + i / 100.0, i < 100 ? PoseStatus::ok : PoseStatus::out_of_view, {}, 0};
  std::filesystem::create_directories("devices_test_files");
  write_file("devices_test_files/lost.igs.mha", write_sequence(log));
  const auto replay = open_tracker("replay:devices_test_files/lost.igs.mha?speed=2");
  std::vector<ProbeSample> out;
  replay->poll(0, out);
  replay->poll(0.9, out);
  CHECK(replay->state().condition == TrackerCondition::tracking);
  CHECK(replay->state().usable == 100);
  replay->poll(1.05, out);
  CHECK(replay->state().condition == TrackerCondition::lost);
  CHECK(replay->state().last_status == PoseStatus::out_of_view);
  CHECK(*replay->state().progress < 1);
  replay->poll(1.5, out);
  CHECK(replay->state().condition == TrackerCondition::finished);
  CHECK(same_bits(out, log));
  std::filesystem::remove_all("devices_test_files");
}

TEST_CASE("a synthetic hand is the same for its seed, however it is polled, and another for another") {
  for (const std::uint32_t seed : {1u, 2u, 4000000000u}) {
    SyntheticTracker a(seed, 60, {}), b(seed, 60, {});
    const auto often = poll_until(a, 30, 144);
    const auto rarely = poll_until(b, 30, 0.7);
    CHECK(often.size() == 1801);
    CHECK(same_bits(often, rarely));
    SyntheticTracker other(seed + 1, 60, {});
    CHECK_FALSE(same_bits(poll_until(other, 30, 60), often));
  }
}

TEST_CASE("a hand needs a body with a size") {
  CHECK_THROWS_AS(SyntheticTracker(1, 60, {{0, 0, 0}, {100, 0, 100}, {}}), std::invalid_argument);
  CHECK_THROWS_AS(SyntheticTracker(1, 60, {{0, 0, 0}, {100, std::nan(""), 100}, {}}), std::invalid_argument);
}

TEST_CASE("a synthetic hand stays on the body's front, looks into it, moves as a hand does and drops out at times") {
  const TrackerContext body{{-150, -260, 900}, {170, -20, 1300}, {}};
  const glm::dvec3 centre = (body.body_min + body.body_max) / 2.0;
  int dropouts = 0;
  std::size_t total = 0;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    SyntheticTracker hand(seed, 60, body);
    const auto samples = poll_until(hand, 60, 10);
    total += samples.size();
    const ProbeSample* before = nullptr;
    for (const ProbeSample& sample : samples) {
      if (sample.status != PoseStatus::ok) {
        ++dropouts;
        before = nullptr;
        continue;
      }
      const Pose& pose = sample.patient_from_probe;
      REQUIRE_FALSE(why_not_rigid(pose.matrix()));
      const glm::dvec3 p = pose.translation;
      // On the skin but for tremor and noise.
      CHECK(glm::all(glm::greaterThan(p, body.body_min - 1.0)));
      CHECK(glm::all(glm::lessThan(p, body.body_max + 1.0)));
      CHECK(p.y < centre.y);
      const glm::dvec3 beam = pose.direction({0, 1, 0});
      CHECK(glm::dot(beam, glm::dvec3(centre.x, centre.y, p.z) - p) > 0);
      if (before) {
        // A reach of 400 mm in 1.2 s at least, by a path of least jerk, peaks at 1.9 times its mean speed; noise of
        // 0.15 mm each way adds 30 mm/s at 60 Hz along each axis.
        const double mm_per_s = glm::distance(p, before->patient_from_probe.translation) * 60;
        CHECK(mm_per_s < 400 / 1.2 * 1.9 + 60);
      }
      before = &sample;
    }
  }
  CHECK(dropouts > 0);
  CHECK(dropouts < int(total) / 20);
}

TEST_CASE("the mouse gives 60 samples a second, and what is pushed moves the probe in its own frame") {
  // The probe looks to the patient's back, its marker to the patient's right.
  const Pose start{glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1)), {10, -100, 50}};
  MouseTracker mouse(start);
  std::vector<ProbeSample> samples;
  mouse.poll(7, samples);
  REQUIRE(samples.size() == 1);
  CHECK(samples[0].time_s == 0);
  CHECK(samples[0].patient_from_probe.translation == start.translation);

  mouse.move({3, 0, 0}, {});
  mouse.move({0, 2, 1}, {});
  mouse.hold_buttons(5);
  mouse.poll(7.0501, samples);
  REQUIRE(samples.size() == 4);
  CHECK(glm::distance(samples[3].patient_from_probe.translation, glm::dvec3(10 - 3, -100 + 2, 50 - 1)) < 1e-12);
  CHECK(samples[3].buttons == 5);
  // Spread evenly over the samples that came.
  for (int i = 1; i <= 3; ++i) CHECK(samples[std::size_t(i)].patient_from_probe.translation.x == Approx(10 - i));

  mouse.move({}, {glm::half_pi<double>(), 0, 0});
  mouse.poll(7.2, samples);
  const Pose turned = samples.back().patient_from_probe;
  CHECK(glm::distance(turned.direction({0, 1, 0}), start.direction({0, 0, 1})) < 1e-12);
  CHECK(glm::distance(turned.direction({1, 0, 0}), start.direction({1, 0, 0})) < 1e-12);
  for (std::size_t i = 1; i < samples.size(); ++i) CHECK(samples[i].time_s - samples[i - 1].time_s == Approx(1 / 60.0));

  // However many samples it takes, a probe that is moved and turned at once ends where it was sent.
  const Pose quarter{glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0)), {60, -20, 40}};
  mouse.place(start);
  mouse.move(quarter.translation, {glm::half_pi<double>(), 0, 0});
  mouse.poll(7.3, samples);
  CHECK(glm::distance(samples.back().patient_from_probe.translation, (start * quarter).translation) < 1e-12);
  CHECK(glm::distance(samples.back().patient_from_probe.rotation[1], (start * quarter).rotation[1]) < 1e-12);

  mouse.place(start);
  mouse.poll(7.4, samples);
  CHECK(glm::distance(samples.back().patient_from_probe.translation, start.translation) < 1e-12);
}

TEST_CASE("a time that runs backwards, or is none, brings nothing and moves nothing") {
  MouseTracker mouse({});
  std::vector<ProbeSample> samples;
  mouse.poll(10, samples);
  mouse.move({6, 0, 0}, {});
  for (const double now_s : {9.0, -1e300, std::nan(""), 10.0}) mouse.poll(now_s, samples);
  CHECK(samples.size() == 1);
  mouse.poll(10.0501, samples);
  CHECK(samples.size() == 4);
  CHECK(samples.back().patient_from_probe.translation.x == Approx(6));
}

TEST_CASE("a steady rate moves the mouse's probe as far whatever the polls, and never out of shape") {
  for (const double polls_per_s : {1.0, 60.0, 144.0}) {
    MouseTracker mouse({});
    std::vector<ProbeSample> samples;
    mouse.poll(0, samples);
    mouse.move_steadily({0, 0, 12}, {0, 0, 0.3});
    for (int i = 1; i <= 600 * polls_per_s; ++i) mouse.poll(i / polls_per_s + 1e-6, samples);
    CHECK(samples.size() == 36001);
    CHECK(mouse.pose().translation.z == Approx(7200));
    const double turned_deg = std::abs(std::remainder(glm::degrees(0.3 * 600), 360));
    CHECK(angle_between_deg(mouse.pose(), {}) == Approx(turned_deg));
    const glm::dmat3 excess = glm::transpose(mouse.pose().rotation) * mouse.pose().rotation - glm::dmat3(1.0);
    for (int c = 0; c < 3; ++c) CHECK(glm::length(excess[c]) < 1e-14);
    mouse.move_steadily({}, {});
    samples.clear();
    mouse.poll(601, samples);
    CHECK(samples.back().patient_from_probe.translation.z == Approx(7200));
  }
}

TEST_CASE("a made-up hand can be had live: its own samples, stamped as they come, through a live tracker's filters") {
  const auto live = open_tracker("synthetic:3?rate=500&live=1&filter=off");
  CHECK(live->live());
  std::vector<ProbeSample> samples;
  while (samples.size() < 40) live->poll(steady_now_s(), samples);
  const auto hand = open_tracker("synthetic:3?rate=500");
  CHECK_FALSE(hand->live());
  std::vector<ProbeSample> same;
  hand->poll(0, same);
  hand->poll(1, same);
  for (std::size_t i = 0; i < 40; ++i) {
    CHECK(samples[i].patient_from_probe == same[i].patient_from_probe);
    if (i > 0) CHECK(samples[i].time_s > samples[i - 1].time_s);
  }
  const auto filters = [](const std::string& uri) {
    const auto tracker = open_tracker(uri);
    return to_string(dynamic_cast<const LiveTracker&>(*tracker).filters());
  };
  CHECK(filters("synthetic:3?live=1") == "1euro,outlier");
  CHECK(filters("synthetic:3?live=1&filter=outlier") == "outlier");
  CHECK_THROWS_WITH(open_tracker("synthetic:3?filter=outlier"), Catch::Contains("only a live tracker"));

  INFO("and the filters do their work");
  const auto smooth = open_tracker("synthetic:3?rate=500&live=1&filter=1euro");
  std::vector<ProbeSample> smoothed;
  while (smoothed.size() < 40) smooth->poll(steady_now_s(), smoothed);
  CHECK(smoothed[0].patient_from_probe == same[0].patient_from_probe);
  CHECK_FALSE(smoothed[20].patient_from_probe == same[20].patient_from_probe);
}
