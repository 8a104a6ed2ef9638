#include <catch2/catch.hpp>

#include <algorithm>

#include "app/trainer/trainer.h"
#include "devices/calibration/calibration.h"
#include "scenarios/result_json.h"
#include "sim/files/files.h"
#include "tests/app/trainer/trainer_folder.h"
#include "tests/gl/test_context.h"

using namespace insonate;
namespace fs = std::filesystem;

TEST_CASE("the trainer replays a log, draws it, and leaves a report and the runner's score") {
  const test::TestContext context;
  const TrainerFolder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.session());
  std::vector<std::string> said;
  for (int i = 0; i < 150; ++i) {
    trainer.update(i / 30.0);
    for (const Notice& notice : trainer.take_notices()) said.push_back(notice.text);
    if (!trainer.best_frame_due()) continue;
    trainer.draw(kSizes);
    trainer.keep_best_frame();
  }
  CHECK(said == std::vector<std::string>{"Step 1 is done: the view was held."});
  trainer.write_results_if_due();
  REQUIRE(trainer.session()->result());
  REQUIRE(trainer.result_files());

  const ExamResult written =
      result_from_json(read_file(trainer.result_files()->score), trainer.result_files()->score.string());
  Runner runner(*trainer.session()->loaded_case().scenario, trainer.session()->loaded_case().subject,
                trainer.session()->loaded_case().tissues);
  runner.feed(samples_of(4, 60, [](double t) { return Pose{glm::dmat3(1.0), {0, 1, std::max(2.0, 20 - 20 * t)}}; }));
  runner.end();
  CHECK(written.points == runner.result().points);
  CHECK(written.percent == runner.result().percent);
  CHECK(written.provenance.log == "scan.igs.mha");
  CHECK_FALSE(written.provenance.log_digest.empty());
  CHECK(read_file(trainer.result_files()->report).find("data:image/png;base64,iVBOR") != std::string::npos);
  // The picture that was kept shows something: tissue below the face, and black beside the fan.
  REQUIRE(trainer.best_frame());
  const Image<Rgba8>& frame = *trainer.best_frame();
  CHECK(frame.at(frame.width / 2, frame.height / 3)[0] > 20);
  CHECK(frame.at(1, 1)[3] == 0);
}

TEST_CASE("a tracker with a calibration gives the probe's pose, and an old calibration warns") {
  const test::TestContext context;
  const TrainerFolder folder;
  Calibration calibration;
  calibration.tracker = {"replay", ""};
  // A sensor 5 mm behind the face, and a mannequin that lies as the patient does.
  calibration.tip = Dated<TipFit>{{}, 1767225600};
  calibration.face = Dated<FaceSetup>{FaceSetup{{Pose{glm::dmat3(1.0), {0, 5, 0}}, 0, 0}, "touch", 0}, 1767225600};
  MannequinSetup mannequin;
  mannequin.patient = mannequin.worst = "tiny";
  mannequin.landmarks.resize(7, {"a place", {}, {}, false});
  calibration.mannequin = Dated<MannequinSetup>{mannequin, 1767225600};
  Options options = folder.options();
  options.calibration = folder.path / "lab.toml";
  write_calibration(options.calibration, calibration);
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.session());
  trainer.update(0);
  trainer.update(0.001);
  REQUIRE(trainer.session()->shown_pose());
  CHECK(trainer.session()->shown_pose()->translation == glm::dvec3(0, 6, 20));
  CHECK(trainer.calibration_warning().find("days old") != std::string::npos);

  // A recording that is opened meanwhile is of the probe already.
  fs::copy_file(folder.path / "scan.igs.mha", folder.path / "other.igs.mha");
  open_and_wait(trainer, folder.path / "other.igs.mha");
  trainer.update(0);
  trainer.update(0.001);
  CHECK(trainer.session()->shown_pose()->translation == glm::dvec3(0, 1, 20));
  CHECK(trainer.calibration_warning().empty());
}

TEST_CASE("the time of a scenario stands still until its briefing was read, and a recorded scan has none") {
  const test::TestContext context;
  const TrainerFolder folder;
  Options options = folder.options();
  const auto briefing_of = [](const Options& given) {
    Trainer trainer(given);
    trainer.open_from_options();
    trainer.finish_loading();
    return trainer.briefing() != nullptr;
  };
  CHECK_FALSE(briefing_of(options));
  options.tracker = "mouse:";
  options.headless = true;
  CHECK_FALSE(briefing_of(options));
  options.headless = false;
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.briefing());
  for (int i = 0; i < 40; ++i) trainer.update(i);
  CHECK(trainer.session()->latest_samples().empty());
  CHECK_FALSE(trainer.session()->result());  // the exam lasts 30 s
  trainer.start();
  CHECK_FALSE(trainer.briefing());
  trainer.update(40);
  trainer.update(41);
  CHECK(trainer.session()->runner()->live().elapsed_s == Approx(1).margin(0.1));
  trainer.session()->start_over();
  CHECK_FALSE(trainer.briefing());  // it was read
}

TEST_CASE("while a page covers the screen no time passes in practice, and goes on from there") {
  const test::TestContext context;
  const TrainerFolder folder;
  Options options = folder.options();
  options.tracker = "mouse:";
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  trainer.start();
  double now_s = 100;
  const auto pass = [&](double seconds) {
    for (const double end_s = now_s + seconds; now_s < end_s - 1e-9; now_s += 0.1) trainer.update(now_s);
  };
  const auto elapsed_s = [&] { return trainer.session()->runner()->live().elapsed_s; };
  constexpr double kSample_s = 0.02;  // the mouse gives 60 samples a second
  pass(2);
  const double before_s = elapsed_s();
  CHECK(before_s == Approx(1.9).margin(kSample_s));  // the first update starts the clock
  trainer.cover(true);
  CHECK_FALSE(trainer.time_runs_on());
  pass(50);  // the exam lasts 30 s
  CHECK(elapsed_s() == before_s);
  trainer.cover(false);
  pass(1);
  CHECK(elapsed_s() == Approx(before_s + 1).margin(kSample_s));
  CHECK(trainer.session()->attempt_for_s() == Approx(2.9).margin(1e-6));
}
