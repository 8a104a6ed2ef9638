#include <catch2/catch.hpp>

#include "devices/live/probe_buttons.h"
#include "devices/mouse/mouse_tracker.h"
#include "tests/app/session/tiny_session.h"

using namespace insonate;

TEST_CASE("the probe's freeze button freezes the picture and thaws it, once each time that it is pressed") {
  auto samples = searching_scan();
  for (ProbeSample& sample : samples) {
    const bool freezes = std::abs(sample.time_s - 1.25) < 0.25, thaws = std::abs(sample.time_s - 3.15) < 0.15;
    sample.status = PoseStatus::ok;
    sample.buttons = freezes || thaws ? kFreezeButton | kEventMarkerButton : kEventMarkerButton;
    // While the button is held the tracker is lost for a moment.
    if (std::abs(sample.time_s - 1.25) < 0.05) {
      sample.status = PoseStatus::missing;
      sample.buttons = 0;
    }
  }
  Session session(tiny_loaded_case(), replay_of(samples));
  session.advance(0);
  double now_s = run_until(session, 0, 0.9);
  CHECK_FALSE(session.machine().frozen);
  now_s = run_until(session, now_s, 2);
  CHECK(session.machine().frozen);
  const Pose frozen = *session.shown_pose();
  now_s = run_until(session, now_s, 2.9);
  CHECK(*session.shown_pose() == frozen);
  run_until(session, now_s, 4);
  CHECK_FALSE(session.machine().frozen);
  CHECK_FALSE(*session.shown_pose() == frozen);
}

TEST_CASE("the probe's mark and go-on buttons act once each time they are pressed, also across a dropout") {
  auto samples = searching_scan();
  for (ProbeSample& sample : samples) {
    sample.status = PoseStatus::ok;
    const bool first = std::abs(sample.time_s - 1.25) < 0.25, second = std::abs(sample.time_s - 3) < 0.1;
    sample.buttons = first || second ? std::uint32_t(kEventMarkerButton) : 0;
    if (std::abs(sample.time_s - 2) < 0.2) sample.buttons = kContinueButton;
    if (std::abs(sample.time_s - 1.25) < 0.1) sample = {sample.time_s, PoseStatus::missing, Pose{}, 0};
  }
  Session session(tiny_loaded_case(), replay_of(samples));
  session.advance(100);
  double now_s = run_until(session, 100, 101.9);
  CHECK(session.event_markers_s().size() == 1);
  now_s = run_until(session, now_s, 104);
  REQUIRE(session.event_markers_s().size() == 2);
  // The first sample behind that time, and a frame until it is polled.
  CHECK(session.event_markers_s()[0] == Approx(1).margin(0.04));
  CHECK(session.event_markers_s()[1] == Approx(2.9).margin(0.04));
  CHECK(session.take_go_on());
  CHECK_FALSE(session.take_go_on());
  CHECK_FALSE(session.machine().frozen);

  INFO("a mark of the keyboard is in one sample, for the record");
  session.press(kEventMarkerButton);
  std::size_t marked = 0;
  for (int i = 1; i <= 30; ++i) {
    session.advance(now_s + i / 60.0);
    for (const ProbeSample& sample : session.latest_samples()) marked += sample.buttons == kEventMarkerButton;
  }
  CHECK(session.event_markers_s().size() == 3);
  CHECK(marked == 1);
  session.start_over();
  CHECK(session.event_markers_s().empty());
}

TEST_CASE("a button that is held when a session begins was pressed for somebody else") {
  auto samples = searching_scan();
  for (ProbeSample& sample : samples)
    sample.buttons = sample.time_s < 1 || sample.time_s > 2 ? kFreezeButton | kEventMarkerButton : 0;
  Session session(tiny_loaded_case(), replay_of(samples));
  session.advance(0);
  const double now_s = run_until(session, 0, 1.5);
  CHECK_FALSE(session.machine().frozen);
  CHECK(session.event_markers_s().empty());
  run_until(session, now_s, 3);
  CHECK(session.machine().frozen);
  CHECK(session.event_markers_s().size() == 1);
}

TEST_CASE("a button that is held on the tracker while the probe changes hands was pressed once") {
  std::vector<ProbeSample> coming;
  Session session(tiny_loaded_case(), [&] { return std::make_unique<HandFed>(coming); });
  double now_s = 100;
  const auto hold = [&](std::uint32_t buttons) {
    coming = {sample_at(now_s, turned(0, {1, 0, 0}, {0, 1, 3}))};
    coming[0].buttons = buttons;
    session.advance(now_s += 0.1);
  };
  session.advance(now_s);
  hold(0);
  hold(kEventMarkerButton | kFreezeButton);
  CHECK(session.machine().frozen);
  CHECK(session.event_markers_s().size() == 1);
  session.take_probe();
  hold(kEventMarkerButton | kFreezeButton);
  session.press(kEventMarkerButton);  // the keyboard's own
  hold(kEventMarkerButton | kFreezeButton);
  CHECK(session.event_markers_s().size() == 1);
  session.give_back_probe();
  hold(kEventMarkerButton | kFreezeButton);
  CHECK_FALSE(session.machine().frozen);
  CHECK(session.event_markers_s().empty());
  hold(0);
  hold(kEventMarkerButton);
  CHECK(session.event_markers_s().size() == 1);
}
