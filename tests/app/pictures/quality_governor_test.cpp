#include "app/pictures/quality_governor.h"

#include <catch2/catch.hpp>

using insonate::QualityGovernor;

namespace {

/// A governor with the loop around it: frames follow each other, each as long as it takes to draw.
struct Run {
  QualityGovernor governor;
  double now_s = 1000;

  void frame(double frame_s, bool computed) {
    governor.see(now_s, frame_s, computed);
    now_s += frame_s;
  }
  void move(int frames, double frame_s) {
    for (int i = 0; i < frames; ++i) frame(frame_s, true);
  }
  /// As the window goes on: nothing changes, and what follows from the quality is computed.
  /// @return  the pictures computed
  int rest(double seconds) {
    int computed = 0;
    double drawn = governor.quality();
    for (const double end_s = now_s + seconds; now_s < end_s;) {
      const bool due = governor.quality() != drawn;
      drawn = governor.quality();
      computed += due ? 1 : 0;
      frame(0.016, due);
    }
    return computed;
  }
};

}  // namespace

TEST_CASE("a machine that cannot keep up draws fewer pixels while the picture moves, and all of them once it stands") {
  Run run;
  run.move(30, 0.08);
  const double of_motion = run.governor.quality();
  CHECK(of_motion < 1);
  CHECK(of_motion >= QualityGovernor::kMin);

  CHECK(run.rest(5) == 1);
  CHECK(run.governor.quality() == 1);
  run.move(2, 0.08);
  CHECK(run.governor.quality() == of_motion);

  run.move(1000, 0.08);
  CHECK(run.governor.quality() == QualityGovernor::kMin);
  // Where a frame takes longer than a picture has to stand still for.
  run.rest(5);
  run.move(2, 3 * QualityGovernor::kRest_s);
  CHECK(run.governor.quality() == QualityGovernor::kMin);
}

TEST_CASE("a software renderer's first motion begins where it would come to, and a quick one draws all of it soon") {
  Run run{QualityGovernor(true)};
  CHECK(run.rest(1) == 0);
  CHECK(run.governor.quality() == 1);
  run.move(2, 0.03);
  CHECK(run.governor.quality() < 0.8);
  CHECK(run.governor.frames_per_turn() == 2);
  run.move(200, 0.008);
  CHECK(run.governor.quality() == 1);
  CHECK(run.governor.frames_per_turn() == 0);
}

TEST_CASE("a picture that comes alone is drawn in full, however slow the machine") {
  Run run;
  run.move(1000, 0.08);
  for (int knob = 0; knob < 50; ++knob) {
    run.rest(1);
    run.frame(4.0, true);  // as of a shader that has to be built
    CHECK(run.governor.quality() == 1);
  }
  CHECK(run.rest(5) == 0);
}

TEST_CASE("a frame that waited for something else leaves the next ones as they are") {
  Run run;
  for (int i = 0; i < 2000; ++i) {
    run.frame(i % 5 == 0 ? 3.0 : 0.034, true);
    REQUIRE(run.governor.quality() == 1);
    REQUIRE(run.governor.frames_per_turn() == 0);
  }
}

TEST_CASE("the views beside the ultrasound give way first, and within half a second of motion the rate is there") {
  // The ultrasound takes a third of the frame and goes with its pixels; the other views take the rest.
  const auto frame_s = [](const QualityGovernor& governor, double whole_s) {
    const int per_turn = governor.frames_per_turn();
    const double views = per_turn == 0 ? 3.0 : 1.0 / per_turn;  // drawn per frame, in the mean
    return whole_s * (governor.quality() * governor.quality() / 3 + views * 2 / 9);
  };
  for (const double whole_s : {0.045, 0.06, 0.07}) {
    Run run;
    run.rest(1);
    const double begin_s = run.now_s;
    while (run.now_s < begin_s + 0.5) {
      run.frame(frame_s(run.governor, whole_s), true);
      if (run.governor.frames_per_turn() < 2) CHECK(run.governor.quality() == 1);
    }
    CHECK(frame_s(run.governor, whole_s) <= 1.04 * QualityGovernor::kFrame_s);
    run.rest(1);
    CHECK(run.governor.quality() == 1);
    CHECK(run.governor.frames_per_turn() == 0);
  }
}

TEST_CASE("with the fewest pixels the other views wait longer, and have their turns again before there are more") {
  Run run;
  while (run.governor.frames_per_turn() < 5) {
    if (run.governor.frames_per_turn() > 2) CHECK(run.governor.quality() == QualityGovernor::kMin);
    REQUIRE(run.now_s < 1010);
    run.frame(0.08, true);
  }
  while (run.governor.frames_per_turn() > 2) {
    CHECK(run.governor.quality() == QualityGovernor::kMin);
    REQUIRE(run.now_s < 1020);
    run.frame(0.02, true);
  }
  CHECK(run.governor.quality() == QualityGovernor::kMin);
}

TEST_CASE("a screen that shows every second refresh takes no turns from the other views") {
  Run run;
  while (run.governor.quality() > QualityGovernor::kMin) run.frame(0.08, true);
  const int turns = run.governor.frames_per_turn();
  run.move(300, QualityGovernor::kFrame_s);
  CHECK(run.governor.frames_per_turn() == turns);
}

TEST_CASE("frames that draw another view and take longer do not keep the rate from its goal") {
  // With a view in each third frame the median is quick enough, and the mean is 34 ms.
  Run run{QualityGovernor(true)};
  run.move(100, 0.08);
  int pictures = 0, since_view = 0;
  double begin_s = 0;
  for (int i = 0; i < 600; ++i) {
    const bool view = ++since_view >= run.governor.frames_per_turn();
    if (view) since_view = 0;
    run.frame(view ? 0.045 : 0.029, true);
    if (i == 200) begin_s = run.now_s;
    pictures += i > 200 ? 1 : 0;
  }
  CHECK(pictures / (run.now_s - begin_s) > 30);
  CHECK(run.governor.frames_per_turn() == 5);
}

TEST_CASE("a machine that can keep up again draws all pixels again, and one at its limit does not waver") {
  Run run;
  run.move(1000, 0.08);
  REQUIRE(run.governor.quality() == QualityGovernor::kMin);
  run.move(1000, 0.02);
  CHECK(run.governor.quality() == 1);

  // What a frame costs goes with its pixels at most.
  for (const double whole_s : {0.03, 0.046, 0.05, 0.06, 0.08, 0.1}) {
    const auto settle = [&](int frames) {
      int changes = 0;
      for (int i = 0; i < frames; ++i) {
        const double quality = run.governor.quality();
        run.frame(whole_s * quality * quality, true);
        changes += run.governor.quality() != quality ? 1 : 0;
      }
      return changes;
    };
    settle(200);
    CHECK(settle(1000) == 0);
  }
}
