#include "devices/live/live_tracker.h"

#include <catch2/catch.hpp>

#include <atomic>
#include <memory>

#include "devices/live/detached_threads.h"
#include "tests/devices/live/scripted_source.h"

using namespace insonate;
using std::chrono::milliseconds;

namespace {

/// Patience of a test, not of a person.
LiveTracker::Options hasty() {
  LiveTracker::Options options;
  options.first_pause = milliseconds(5);
  options.longest_pause = milliseconds(20);
  options.silence = milliseconds(100);
  options.heartbeat = milliseconds(20);
  options.ending = milliseconds(60000);  // the devices are the tests' own and end with them
  return options;
}

std::unique_ptr<LiveTracker> tracker_of(ScriptedDevice& device, const LiveTracker::Options& options = hasty()) {
  return std::make_unique<LiveTracker>(std::make_unique<ScriptedSource>(device), options);
}

std::size_t count(const std::vector<ProbeSample>& samples, PoseStatus status) {
  return std::size_t(std::count_if(samples.begin(), samples.end(), [&](auto& s) { return s.status == status; }));
}

}  // namespace

TEST_CASE("a live tracker publishes every sample once, in order, with rising times on the clock it is polled with") {
  ScriptedDevice device;
  device.in_one_read = 8;
  const auto tracker = tracker_of(device);
  CHECK(tracker->live());
  CHECK(tracker->state().condition == TrackerCondition::waiting);
  INFO("who only asks for its state opens nothing");
  CHECK(device.opened == 0);
  const double before_s = steady_now_s();
  std::vector<ProbeSample> samples;
  REQUIRE(poll_until(*tracker, samples, [&] { return samples.size() >= 400; }));
  const double after_s = steady_now_s();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    REQUIRE(samples[i].status == PoseStatus::ok);
    REQUIRE(samples[i].buttons == i + 1);
    if (i > 0) REQUIRE(samples[i].time_s > samples[i - 1].time_s);
  }
  CHECK(samples.front().time_s >= before_s);
  CHECK(samples.back().time_s <= after_s);
  CHECK(tracker->clock_s(after_s) == after_s);
  const TrackerState state = tracker->state();
  CHECK(state.condition == TrackerCondition::tracking);
  CHECK(state.delivered == samples.size());
  CHECK(state.dropped == 0);
  CHECK(state.problem.empty());
}

TEST_CASE("a live tracker reports a place or none as its device does, before it is opened") {
  ScriptedDevice device;
  CHECK_FALSE(tracker_of(device)->relative());
  device.relative = true;
  CHECK(tracker_of(device)->relative());
  CHECK(device.opened == 0);
}

TEST_CASE("a device may be plugged in late, pulled out and plugged in again, and every state has its words") {
  ScriptedDevice device;
  device.plugged_in = false;
  const auto tracker = tracker_of(device);
  std::vector<ProbeSample> samples;
  REQUIRE(poll_until(*tracker, samples, [&] { return !tracker->state().problem.empty(); }));
  CHECK(tracker->state().problem == "The scripted device is not plugged in.");
  CHECK(tracker->state().condition == TrackerCondition::waiting);
  CHECK(samples.empty());

  device.plugged_in = true;
  REQUIRE(poll_until(*tracker, samples, [&] { return samples.size() > 10; }));
  REQUIRE(poll_until(*tracker, samples, [&] { return tracker->state().problem.empty(); }));
  CHECK(tracker->state().condition == TrackerCondition::tracking);

  for (int round = 1; round <= 3; ++round) {
    device.plugged_in = false;
    REQUIRE(poll_until(*tracker, samples, [&] { return device.closed == round; }));
    INFO("the silence is shown by samples that carry no pose");
    samples.clear();
    REQUIRE(poll_until(*tracker, samples, [&] { return count(samples, PoseStatus::missing) >= 3; }));
    CHECK(tracker->state().problem == "The scripted device is not plugged in.");
    if (round == 1) {
      REQUIRE(poll_until(*tracker, samples, [&] { return tracker->state().condition == TrackerCondition::lost; }));
    }
    device.plugged_in = true;
    samples.clear();
    REQUIRE(poll_until(*tracker, samples, [&] { return count(samples, PoseStatus::ok) > 3; }));
    REQUIRE(poll_until(*tracker, samples, [&] { return tracker->state().problem.empty(); }));
    CHECK(tracker->state().condition == TrackerCondition::tracking);
    CHECK(device.opened == round + 1);
  }
  for (std::size_t i = 1; i < samples.size(); ++i) CHECK(samples[i].time_s > samples[i - 1].time_s);
}

TEST_CASE("an open device that says nothing is silent, not gone") {
  ScriptedDevice device;
  const auto tracker = tracker_of(device);
  std::vector<ProbeSample> samples;
  REQUIRE(poll_until(*tracker, samples, [&] { return !samples.empty(); }));
  device.note("The probe is too far from the base.");
  device.silent = true;
  REQUIRE(poll_until(*tracker, samples, [&] { return count(samples, PoseStatus::missing) >= 3; }));
  CHECK(tracker->state().problem == "The probe is too far from the base.");
  CHECK(tracker->state().last_status == PoseStatus::missing);
  CHECK(device.closed == 0);
  device.silent = false;
  device.note("");
  REQUIRE(poll_until(*tracker, samples, [&] { return samples.back().status == PoseStatus::ok; }));
}

TEST_CASE("who does not poll in time loses samples, is informed how many, and stops nobody") {
  ScriptedDevice device;
  device.in_one_read = 50;
  LiveTracker::Options options = hasty();
  options.capacity = 64;
  const auto tracker = tracker_of(device, options);
  std::vector<ProbeSample> samples;
  tracker->poll(steady_now_s(), samples);
  while (device.sent < 1000) std::this_thread::sleep_for(milliseconds(1));
  device.silent = true;
  REQUIRE(poll_until(*tracker, samples, [&] { return count(samples, PoseStatus::missing) >= 1; }));
  CHECK(tracker->state().dropped > 0);
  CHECK(count(samples, PoseStatus::ok) + tracker->state().dropped >= device.sent);
}

TEST_CASE("a tracker ends while its device is open, absent, or was never asked for") {
  ScriptedDevice device;
  { const auto tracker = tracker_of(device); }
  CHECK(device.opened == 0);
  std::vector<ProbeSample> samples;
  {
    const auto tracker = tracker_of(device);
    REQUIRE(poll_until(*tracker, samples, [&] { return !samples.empty(); }));
  }
  CHECK(device.opened == 1);
  CHECK(device.closed == 1);
  device.plugged_in = false;
  LiveTracker::Options patient;
  patient.first_pause = std::chrono::hours(1);  // which ending must not wait for
  patient.longest_pause = std::chrono::hours(1);
  {
    const auto tracker = tracker_of(device, patient);
    REQUIRE(poll_until(*tracker, samples, [&] { return !tracker->state().problem.empty(); }));
  }
  CHECK(device.closed == 1);
}

TEST_CASE("a device that does not let go keeps nobody waiting but the next that opens one") {
  struct Door {
    std::atomic<int> opened{0}, closing{0};
    std::atomic<bool> may_close{false};
  };
  struct Slow : LiveSource {
    explicit Slow(std::shared_ptr<Door> its) : door(std::move(its)) {}
    std::string name() const override { return "a slow device"; }
    void open() override { ++door->opened; }
    void read(milliseconds, LiveBatch& batch) override {
      std::this_thread::sleep_for(milliseconds(1));
      batch.samples.push_back({steady_now_s(), PoseStatus::ok, {}, 0});
    }
    void close() noexcept override {
      ++door->closing;
      while (!door->may_close) std::this_thread::sleep_for(milliseconds(1));
    }
    std::shared_ptr<Door> door;
  };
  LiveTracker::Options options;
  options.ending = milliseconds(10);
  const auto first = std::make_shared<Door>(), second = std::make_shared<Door>();
  second->may_close = true;
  std::vector<ProbeSample> samples;
  {
    LiveTracker tracker(std::make_unique<Slow>(first), options);
    REQUIRE(poll_until(tracker, samples, [&] { return !samples.empty(); }));
  }
  CHECK(first->opened == 1);
  LiveTracker next(std::make_unique<Slow>(second), options);
  samples.clear();
  next.poll(steady_now_s(), samples);
  while (second->opened == 0 && waiting_for_detached_threads() == 0) std::this_thread::sleep_for(milliseconds(1));
  CHECK(second->opened == 0);
  CHECK(first->closing == 1);
  first->may_close = true;
  CHECK(poll_until(next, samples, [&] { return !samples.empty(); }));
}
