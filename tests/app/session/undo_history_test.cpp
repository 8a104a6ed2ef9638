// What a person has done to knobs and probe is taken back, step by step.
#include "app/session/undo_history.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "devices/mouse/mouse_tracker.h"
#include "tests/app/session/tiny_session.h"

using namespace insonate;

namespace {

/// A session that nobody but the learner moves the probe in, watched as the trainer does it.
struct Watched {
  explicit Watched(ExamRules rules = ExamRules::open, bool with_exam = false)
      : session(
            tiny_loaded_case(with_exam), [] { return std::make_unique<MouseTracker>(Pose{}); }, 0, rules) {
    pass(0.1);
  }
  void pass(double seconds) {
    for (int i = 0; i < int(std::lround(60 * seconds)); ++i) {
      session.advance(now_s += 1.0 / 60);
      history.watch(session);
    }
  }
  void slide(double mm) {
    session.move_probe([&](const ProbeHand&, const Pose& pose) -> std::optional<Pose> {
      return Pose{pose.rotation, pose.translation + glm::dvec3(mm, 0, 0)};
    });
  }
  double x_mm() const { return session.newest_pose()->translation.x; }

  Session session;
  UndoHistory history;
  double now_s = 0;
};

}  // namespace

TEST_CASE("knobs go back one by one, and forward again") {
  Watched w;
  const Machine before = w.session.machine();
  w.session.set(ActionKind::depth, 90);
  w.pass(1);
  w.session.set(ActionKind::gain, 12);
  w.pass(1);
  const Machine after = w.session.machine();

  CHECK(w.history.undo(w.session).empty());
  CHECK(w.session.machine().gain_db == before.gain_db);
  CHECK(w.session.machine().depth_mm == 90);
  w.pass(1);
  CHECK(w.history.undo(w.session).empty());
  CHECK(w.session.machine() == before);
  w.pass(1);
  CHECK(w.history.undo(w.session) == "Nothing to undo");

  CHECK(w.history.redo(w.session).empty());
  CHECK(w.history.redo(w.session).empty());
  CHECK(w.session.machine() == after);
  CHECK(w.history.redo(w.session) == "Nothing to do again");
}

TEST_CASE("a drag is one step, and what comes after a step back takes the place of what was ahead") {
  Watched w;
  const double start = w.x_mm();
  for (int i = 0; i < 20; ++i) {
    w.slide(0.5);
    w.pass(0.05);
  }
  w.pass(1);
  REQUIRE(w.x_mm() == Approx(start + 10));
  w.slide(7);
  w.pass(0.1);  // not yet still: it counts all the same
  CHECK(w.history.undo(w.session).empty());
  w.pass(1);
  CHECK(w.x_mm() == Approx(start + 10));
  CHECK(w.history.undo(w.session).empty());
  w.pass(1);
  CHECK(w.x_mm() == Approx(start));
  w.session.set(ActionKind::gain, 5);
  w.pass(1);
  CHECK(w.history.redo(w.session) == "Nothing to do again");
}

TEST_CASE("a move with a rotation goes back in one step, however it is rounded") {
  Watched w;
  w.session.set(ActionKind::gain, 9);
  w.pass(1);
  for (int i = 0; i < 30; ++i) {
    w.session.move_probe([&](const ProbeHand&, const Pose& pose) { return ProbeHand::turn(pose, 1.1, 0.7, -0.4); });
    w.slide(0.3);
    w.pass(1.0 / 60);
  }
  w.pass(1);
  CHECK(w.history.undo(w.session).empty());
  w.pass(1);
  CHECK(w.session.machine().gain_db == 9);
  CHECK(w.history.undo(w.session).empty());
  CHECK(w.session.machine().gain_db == 0);
}

TEST_CASE("going back is logged like any other action, and nothing goes back into another attempt") {
  Watched w(ExamRules::open, true);
  w.session.set(ActionKind::gain, 9);
  w.pass(1);
  REQUIRE(w.history.undo(w.session).empty());
  w.pass(1);
  std::size_t gains = 0;
  for (const auto& [time_s, actions] : w.session.actions())
    for (const Action& action : actions) gains += action.kind == ActionKind::gain;
  CHECK(gains == 2);

  w.session.set(ActionKind::gain, 9);
  w.pass(1);
  w.session.start_over();
  w.pass(1);
  CHECK(w.history.undo(w.session) == "Nothing to undo");
}

TEST_CASE("a frozen picture stays frozen, and its knobs go back as far as the machine lets them") {
  Watched w;
  w.session.set(ActionKind::depth, 90);
  w.pass(1);
  w.session.set(ActionKind::gain, 9);
  w.pass(1);
  w.session.freeze(true);
  w.pass(1);
  CHECK(w.history.undo(w.session).empty());
  w.pass(1);
  CHECK(w.session.machine().frozen);
  CHECK(w.session.machine().gain_db == 0);
  // The echoes are acquired: the step waits until the picture runs.
  CHECK(w.history.undo(w.session) == w.session.why_not(ActionKind::depth));
  w.pass(1);
  CHECK(w.session.machine().frozen);
  CHECK(w.session.machine().depth_mm == 90);
  w.session.freeze(false);
  w.pass(1);
  CHECK(w.history.undo(w.session).empty());
  CHECK(w.session.machine().depth_mm != 90);
  CHECK(w.history.redo(w.session).empty());
  CHECK(w.history.redo(w.session).empty());
  CHECK(w.session.machine().gain_db == 9);
}

TEST_CASE("in an exam that counts the probe is not put back") {
  Watched w(ExamRules::strict, true);
  w.slide(4);
  w.pass(1);
  const double there = w.x_mm();
  CHECK(w.history.undo(w.session) == "Nothing to undo");
  w.pass(1);
  CHECK(w.x_mm() == there);
}

TEST_CASE("what a replayed log does to the machine is not a person's step") {
  Session session(tiny_loaded_case(false), [] {
    Recording recording{"scan.igs.mha", "digest", "ProbeToPatient"};
    const std::vector<ProbeSample> samples = searching_scan();
    recording.actions[samples[40].time_s] = to_text(std::vector<Action>{{ActionKind::gain, {7}}});
    return std::make_unique<ReplayTracker>("a log", samples, ReplayTracker::Options{}, recording);
  });
  UndoHistory history;
  for (int i = 0; i < 180; ++i) {
    session.advance(i / 60.0);
    history.watch(session);
  }
  REQUIRE(session.machine().gain_db == 7);
  CHECK(history.undo(session) == "Nothing to undo");
}
