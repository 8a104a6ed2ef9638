// What the trainer keeps of exams: attempts, their reports and pictures.
#include <catch2/catch.hpp>

#include <algorithm>

#include "app/session/plane_on_screen.h"
#include "app/trainer/trainer.h"
#include "devices/sequence/sequence.h"
#include "scenarios/result_json.h"
#include "sim/files/files.h"
#include "sim/files/png.h"
#include "tests/app/trainer/trainer_folder.h"
#include "tests/gl/test_context.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// Runs the exam that the options name to its end and its files.
void finish(Trainer& trainer) {
  trainer.open_from_options();
  trainer.finish_loading();
  trainer.start();
  for (int i = 0; i < 1000 && !trainer.result_files(); ++i) {
    trainer.update(i / 30.0);
    if (trainer.best_frame_due()) {
      trainer.draw(kSizes);
      trainer.keep_best_frame();
    }
    trainer.write_results_if_due();
  }
  REQUIRE(trainer.result_files());
  CHECK(trainer.problems().empty());
}

}  // namespace

TEST_CASE("the trainer keeps attempts in the database it was given, and of the user's own accord only those by hand") {
  const test::TestContext context;
  const TrainerFolder folder;
  SECTION("a replayed log in a database that was named") {
    Options options = folder.options();
    options.results = folder.path / "lab.db";
    options.learner = "L-07";
    Trainer trainer(options);
    finish(trainer);
    ResultsDatabase database = ResultsDatabase::open(options.results);
    REQUIRE(database.attempts().size() == 1);
    const Attempt attempt = database.read(1);
    CHECK(attempt.learner == "L-07");
    CHECK(attempt.scenario_text == kTinyScenario);
    CHECK(attempt.patient == (folder.path / "tiny").string());
    CHECK(attempt.score_json == read_file(trainer.result_files()->score));
    REQUIRE(attempt.pictures.size() == 4);  // of two steps, the learner's and the reference
    for (const ReportPicture& picture : attempt.pictures) CHECK(picture.png.starts_with("\x89PNG"));
    CHECK(attempt.pictures[0].png != attempt.pictures[1].png);
    // The same picture as the machine shows at the reference view, and the screen is right again afterwards.
    CHECK(attempt.pictures[1].png == attempt.pictures[3].png);
    write_report_files(folder.path / "again", attempt);
    for (const fs::path& file : trainer.result_files()->all())
      CHECK(read_file(file) == read_file(folder.path / "again" / file.filename()));
    CHECK_FALSE(fs::exists(folder.path / "data"));
  }
  SECTION("by default a replayed log in none, an exam by hand in the user's own") {
    Options options = folder.options();
    {
      Trainer trainer(options);
      finish(trainer);
    }
    CHECK(ResultsDatabase::open(folder.path / "data/insonate/results.db").attempts().empty());
    options.tracker = "mouse:";
    Trainer trainer(options);
    finish(trainer);
    const auto attempts = ResultsDatabase::open(folder.path / "data/insonate/results.db").attempts();
    REQUIRE(attempts.size() == 1);
    CHECK(attempts[0].learner == kNobodyInParticular);
  }
  SECTION("without a window none unless one was named") {
    Options options = folder.options();
    options.headless = true;
    options.tracker = "mouse:";
    Trainer trainer(options);
    finish(trainer);
    CHECK_FALSE(fs::exists(folder.path / "data"));
  }
  SECTION("a database that cannot be used is said at the start, and one's own does not stop a session") {
    Options options = folder.options();
    options.results = folder.file("text.db", "no database");
    CHECK_THROWS_AS(Trainer(options), InputError);
    fs::create_directories(folder.path / "data/insonate/results.db");
    Trainer trainer(folder.options());
    REQUIRE(trainer.problems().size() == 1);
    CHECK(trainer.problems().front().find("results.db") != std::string::npos);
  }
}

TEST_CASE("the picture that the report shows of a measurement has the calipers as they were placed last") {
  const test::TestContext context;
  const TrainerFolder folder;
  folder.file("exam.toml", R"(
format = 2
title = "Measure the ball"
case = "tiny"
pass_mark_percent = 60
time_limit_s = 30
[[step]]
kind = "measure"
title = "Ball"
instruction = "Measure it."
view = "ball"
tool = "distance"
walls = "outer"
[[step.target]]
structures = ["ball"]
[[step.criterion]]
metric = "measurement_error_mm"
full = 2
zero = 10
)");
  const auto placed = [](double x) { return Action{ActionKind::caliper, {1, x, 40, x, 80}}; };
  ActionLog actions{
      {1.0, {{ActionKind::freeze}}}, {1.5, {placed(-15)}}, {2.0, {placed(15)}}, {3.0, {{ActionKind::go_on}}}};
  const bool taken_back = GENERATE(false, true);
  if (taken_back) actions[2.5] = {{ActionKind::take_back, {1}}};
  folder.file("scan.igs.mha", write_sequence(samples_of(4, 60,
                                                        [](double) {
                                                          return Pose{glm::dmat3(1.0), {0, 1, 0}};
                                                        }),
                                             to_texts(actions)));
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  for (int i = 0; i < 1000 && !trainer.session()->result(); ++i) {
    trainer.update(i / 30.0);
    if (!trainer.best_frame_due()) continue;
    trainer.draw(kSizes);
    trainer.keep_best_frame();
  }
  const Image<Rgba8>* const kept = trainer.best_frame();
  REQUIRE(kept);
  const PlaneOnScreen plane({0, 0}, {double(kept->width), double(kept->height)}, trainer.pictures().geometry());
  const auto has_cross = [&](double x) {
    const glm::dvec2 at = plane.screen({x, 80});
    return kept->at(int(at.x), int(at.y)) == Rgba8{255, 214, 64, 255};
  };
  CHECK(has_cross(15) == !taken_back);
  CHECK_FALSE(has_cross(-15));
}

TEST_CASE("the report shows every picture that a step measured in, also after a step whose view was held") {
  const test::TestContext context;
  const TrainerFolder folder;
  std::string exam = kTinyScenario;
  const std::size_t second_step = exam.find("[[step]]", exam.find("[[step]]") + 1);
  exam.erase(second_step, exam.find("[[criterion]]") - second_step);
  exam.insert(second_step, R"([[step]]
kind = "measure"
title = "Volume"
instruction = "Measure it."
view = "ball"
tool = "volume"
walls = "outer"
[[step.target]]
structures = ["ball"]
[[step.criterion]]
metric = "measurement_error_percent"
full = 20
zero = 60
)");
  folder.file("exam.toml", exam);
  const auto placed = [](int slot, double x) { return Action{ActionKind::caliper, {double(slot), x, 40, x, 80}}; };
  /// Returns the learner's picture of the last step after such actions, at 7 s in another plane.
  const auto last_picture = [&](const ActionLog& actions) {
    folder.file("scan.igs.mha", write_sequence(samples_of(9, 60,
                                                          [](double t) {
                                                            return Pose{glm::dmat3(1.0), {0, 1, t > 7 ? 2 : 0}};
                                                          }),
                                               to_texts(actions)));
    Options options = folder.options();
    options.results = folder.path / "lab.db";
    Trainer trainer(options);
    finish(trainer);
    ResultsDatabase database = ResultsDatabase::open(options.results);
    std::vector<Image<std::uint8_t>> best;
    for (const ReportPicture& picture : database.read(database.attempts().back().number).pictures)
      if (picture.kind == ReportPicture::Kind::best) best.push_back(read_png(folder.file("picture.png", picture.png)));
    REQUIRE(best.size() == 2);
    CHECK(best[1].width == best[0].width);
    return std::pair(best[0].height, best[1].height);
  };
  const ActionLog in_two{{6.0, {{ActionKind::freeze}}},   {6.2, {placed(1, -15)}},       {6.4, {placed(2, -5)}},
                         {6.6, {{ActionKind::unfreeze}}}, {7.6, {{ActionKind::freeze}}}, {7.8, {placed(3, 15)}},
                         {8.4, {{ActionKind::go_on}}}};
  const auto [one, two] = last_picture(in_two);
  CHECK(two > 2 * one);  // two pictures and a gap
  // What was measured again in another picture is no longer shown in the first one.
  ActionLog again = in_two;
  again[7.9] = {placed(1, -15)};
  again[8.0] = {placed(2, -5)};
  const auto [single, last] = last_picture(again);
  CHECK(last == single);
}

TEST_CASE("a second attempt's report shows its own best frame, and the last picture when the view was not held") {
  const test::TestContext context;
  const TrainerFolder folder;
  // One step, so that no attempt's frame gives way only because another step came.
  std::string exam = kTinyScenario;
  const std::size_t second_step = exam.find("[[step]]", exam.find("[[step]]") + 1);
  folder.file("exam.toml", exam.erase(second_step, exam.find("[[criterion]]") - second_step));
  /// On the ball for so long, then beside it.
  const auto holding = [](double seconds, double degrees) {
    return write_sequence(samples_of(4, 60, [=](double t) {
      return turned(degrees, {0, 1, 0}, {0, 1, t <= seconds ? 0 : 60});
    }));
  };
  double now_s = 0;
  /// Lets the exam that has just begun run to its end.
  const auto finish = [&](Trainer& trainer) {
    trainer.update(now_s);
    REQUIRE_FALSE(trainer.result_files());  // those of the attempt before
    for (int i = 0; i < 1000 && !trainer.result_files(); ++i, now_s += 1 / 30.0) {
      trainer.update(now_s);
      if (trainer.best_frame_due()) {
        trainer.draw(kSizes);
        trainer.keep_best_frame();
      }
      trainer.write_results_if_due();
    }
    REQUIRE(trainer.result_files());
    CHECK_FALSE(trainer.best_frame_due());  // also when nothing was kept
    return read_file(trainer.result_files()->report);
  };
  // In its place beside the reference view.
  const std::string picture = "<figure><img alt='' src='data:image/png;base64,", none = "The view was not held";
  const auto shows_best = [&](const std::string& report) {
    return report.find("<div class='pictures'>" + picture) != std::string::npos &&
           report.find(none) == std::string::npos;
  };

  Trainer trainer(folder.options());
  folder.file("scan.igs.mha", holding(4, 0));
  trainer.open_from_options();
  trainer.finish_loading();
  const std::string first = finish(trainer);
  CHECK(shows_best(first));
  const std::vector<Rgba8> first_pixels = trainer.best_frame()->pixels;

  folder.file("scan.igs.mha", holding(0.5, 15));  // not held for as long as the first, and yet its own
  trainer.session()->start_over();
  const std::string second = finish(trainer);
  REQUIRE(trainer.best_frame());
  CHECK_FALSE(std::equal(first_pixels.begin(), first_pixels.end(), trainer.best_frame()->pixels.begin()));
  CHECK(shows_best(second));

  // The second attempt's picture lies at hand, but it is not this one's.
  folder.file("scan.igs.mha", holding(-1, 0));
  trainer.session()->start_over();
  const std::string third = finish(trainer);
  CHECK_FALSE(trainer.best_frame());
  CHECK(shows_best(third));
  CHECK(third.find("held best") == std::string::npos);
  const auto learners = [&](const std::string& report) {
    const std::size_t begin = report.find(picture) + picture.size();
    return report.substr(begin, report.find('\'', begin) - begin);
  };
  CHECK(learners(third).size() > 1000);
  CHECK(learners(third) != learners(second));

  // A view that was held for too short a time is shown as one that never was: where the scan ended.
  folder.file("scan.igs.mha", holding(-1, 15));
  trainer.session()->start_over();
  CHECK(learners(finish(trainer)) == learners(second));
}

TEST_CASE("an exam that counts is kept once for a learner, with the seed that drew it, also when it is left early") {
  const test::TestContext context;
  const TrainerFolder folder;
  Options options = folder.options();
  options.results = folder.path / "lab.db";
  options.learner = "L-07";
  options.tracker = "mouse:";
  options.mode = Mode::exam;
  const auto start = [](Trainer& trainer) {
    trainer.open_from_options();
    trainer.finish_loading();
    trainer.start();
  };
  {
    INFO("who has practised it may take it");
    options.mode = Mode::practice;
    Trainer trainer(options);
    start(trainer);
    for (int i = 0; i < 1000 && !trainer.result_files(); ++i) {
      trainer.update(i / 30.0);
      trainer.write_results_if_due();
    }
    REQUIRE(trainer.result_files());
    options.mode = Mode::exam;
  }
  {
    Trainer trainer(options);
    start(trainer);
    REQUIRE(trainer.session());
    CHECK(trainer.session()->strict());
    CHECK_FALSE(trainer.exam_refused());
    for (int i = 0; i < 5; ++i) trainer.update(i / 30.0);

    INFO("help and other material are out of reach");
    trainer.guide().next(*trainer.session());
    CHECK_FALSE(trainer.guide().now(*trainer.session()));
    trainer.begin_setup();
    CHECK_FALSE(trainer.setup());
    open_and_wait(trainer, folder.path / "exam.toml");
    REQUIRE(trainer.problems().size() == 1);
    CHECK(trainer.problems().front().find("taken as it is") != std::string::npos);
    CHECK(trainer.session()->attempt() == 1);

    INFO("the CT and the patient's inside are not to be seen before it is over");
    const auto drawn = [&] {
      trainer.draw(kSizes);
      return trainer.pictures().slice() && trainer.pictures().blend();
    };
    CHECK_FALSE(drawn());
    const Image<Rgba8> closed = read_back(*trainer.pictures().volume());
    trainer.hand_in_exam();
    CHECK(drawn());
    CHECK(read_back(*trainer.pictures().volume()).pixels != closed.pixels);
    trainer.hand_in_exam();  // and no second time
    CHECK(trainer.problems().size() == 1);
  }
  ResultsDatabase database = ResultsDatabase::open(options.results);
  REQUIRE(database.attempts().size() == 2);
  CHECK(database.attempts()[1].learner == "L-07");
  CHECK(database.attempts()[1].complete);
  CHECK(database.attempts()[0].mode == AttemptMode::practice);
  CHECK(database.attempts()[1].mode == AttemptMode::exam);
  const auto seed_of = [&](std::int64_t number) {
    return result_from_json(database.read(number).score_json, "an attempt").provenance.seed;
  };
  CHECK(seed_of(2) != 0);  // drawn out of 2^32
  {
    Trainer again(options);
    start(again);
    CHECK_FALSE(again.session());
    CHECK_FALSE(again.loading());
    REQUIRE(again.problems().size() == 1);
    CHECK(again.problems().front().find("as attempt 2") != std::string::npos);
  }
  options.learner = "L-08";
  options.seed = 5;
  {
    Trainer other(options);
    start(other);
    REQUIRE(other.session());
    for (int i = 0; i < 5; ++i) other.update(i / 30.0);
    other.hand_in_exam();
  }
  REQUIRE(database.attempts().size() == 3);
  CHECK(seed_of(3) == 5);

  INFO("a recorded scan is nobody's exam");
  options.learner = "L-09";
  options.tracker = folder.options().tracker;
  Trainer replayed(options);
  start(replayed);
  CHECK_FALSE(replayed.session());
  CHECK(replayed.problems().size() == 1);
  INFO("what remains is to say why, and to end");
  CHECK(replayed.exam_refused());
  CHECK_FALSE(replayed.is_over());
  replayed.problems().clear();
  CHECK(replayed.is_over());
}
