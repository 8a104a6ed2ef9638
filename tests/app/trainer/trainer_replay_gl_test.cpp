// Runs that the trainer plays again.

#include <catch2/catch.hpp>

#include <utility>

#include "app/trainer/trainer.h"
#include "tests/app/trainer/trainer_folder.h"
#include "tests/gl/test_context.h"

using namespace insonate;
namespace fs = std::filesystem;

TEST_CASE("a replay shows the very picture that the learner saw, whatever knob was turned") {
  const test::TestContext context;
  const TrainerFolder folder;
  Options options = folder.options();
  options.tracker = "mouse:";
  options.record = folder.path / "run.igs.mha";
  Image<Rgba8> untouched, seen;
  {
    Trainer trainer(options);
    trainer.open_from_options();
    trainer.finish_loading();
    trainer.start();
    trainer.update(0);
    trainer.update(0.5);
    trainer.draw(kSizes);
    untouched = read_back(*trainer.pictures().ultrasound());
    Session& session = *trainer.session();
    session.set(ActionKind::gain, 5);
    session.set(ActionKind::dynamic_range, 45);
    for (int slider = 1; slider <= Action::kTimeGainSliders; ++slider)
      session.set({ActionKind::time_gain, {double(slider), 8.0 - 2 * slider}});
    trainer.update(1);
    trainer.draw(kSizes);
    seen = read_back(*trainer.pictures().ultrasound());
    trainer.finish_recording();
  }
  CHECK(seen.pixels != untouched.pixels);
  options.tracker.clear();
  options.mode = Mode::replay;
  options.replay.log = std::exchange(options.record, {});
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.replay());
  const auto shown_at = [&](double time_s) {
    trainer.replay()->seek(time_s);
    trainer.draw(kSizes);
    return read_back(*trainer.pictures().ultrasound()).pixels;
  };
  CHECK((shown_at(1e9) == seen.pixels));
  CHECK((shown_at(0) == untouched.pixels));
}

TEST_CASE("a replay has no session, keeps nothing, and gives way to what is opened next") {
  const test::TestContext context;
  const TrainerFolder folder;
  Options options = folder.options();
  options.tracker.clear();
  options.mode = Mode::replay;
  options.replay.log = folder.path / "scan.igs.mha";
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.replay());
  CHECK_FALSE(trainer.session());
  trainer.update(0);
  trainer.draw(kSizes);
  REQUIRE(trainer.pictures().ultrasound());
  const Image<Rgba8> first = read_back(*trainer.pictures().ultrasound());
  trainer.replay()->toggle();
  for (int i = 0; i < 300; ++i) trainer.update(i / 30.0);
  CHECK(trainer.replay()->time_s() == trainer.replay()->run().duration_s());
  REQUIRE(trainer.replay()->run().result);
  trainer.draw(kSizes);
  CHECK(read_back(*trainer.pictures().ultrasound()).pixels != first.pixels);
  trainer.replay()->seek(0);
  trainer.draw(kSizes);
  CHECK(read_back(*trainer.pictures().ultrasound()).pixels == first.pixels);
  trainer.write_results_if_due();
  CHECK_FALSE(fs::exists(folder.path / "out"));
  CHECK_FALSE(fs::exists(folder.path / "data"));

  open_and_wait(trainer, folder.path / "scan.igs.mha");
  CHECK_FALSE(trainer.replay());
  CHECK(trainer.session());
}
