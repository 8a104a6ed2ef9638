#include <catch2/catch.hpp>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "app/trainer.h"
#include "devices/calibration/calibration.h"
#include "devices/igtl/igtl_reader.h"
#include "devices/sequence/sequence.h"
#include "scenarios/result_json.h"
#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/gl/headless_context.h"
#include "sim/volume/volume_checks.h"
#include "tests/devices/igtl/raw_peer.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// A folder of its own for a test, with the tiny case, its exam, and a scan that shows the ball.
class Folder {
public:
  Folder() : path(fs::temp_directory_path() / ("insonate-trainer-" + std::to_string(getpid()))) {
    fs::create_directories(path);
    setenv("XDG_DATA_HOME", (path / "data").c_str(), 1);  // not the user's own results
    write_case(path / "tiny", tiny_case());
    write_file(path / "exam.toml", kTinyScenario);
    write_file(path / "scan.igs.mha", write_sequence(samples_of(4, 60, [](double t) {
                 return Pose{glm::dmat3(1.0), {0, 1, std::max(2.0, 20 - 20 * t)}};
               })));
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }

  Options options() const {
    Options options;
    options.case_folder = path / "tiny";
    options.scenario = path / "exam.toml";
    options.tracker = "replay:" + (path / "scan.igs.mha").string();
    options.out = path / "out";
    return options;
  }
  fs::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
    return path / name;
  }

  fs::path path;
};

/// A MetaImage of 1 mm voxels along y and z, all of them water.
std::string water(int voxels_along_x, double spacing_x_mm) {
  constexpr int kOthers = 4;
  return "ObjectType = Image\nNDims = 3\nDimSize = " + std::to_string(voxels_along_x) +
         " 4 4\nElementSpacing = " + std::to_string(spacing_x_mm) +
         " 1 1\nElementType = MET_SHORT\nElementDataFile = LOCAL\n" +
         std::string(std::size_t(voxels_along_x) * kOthers * kOthers * sizeof(short), '\0');
}

constexpr PictureSizes kSizes{320, 240, 160, 120};
constexpr double kNoBudget = std::numeric_limits<double>::infinity();

void open_and_wait(Trainer& trainer, const fs::path& path) {
  trainer.open(path);
  trainer.finish_loading();
}

}  // namespace

TEST_CASE("the trainer replays a log, draws it, and leaves a report and the runner's score") {
  const gl::HeadlessContext context;
  const Folder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.session());
  for (int i = 0; i < 150; ++i) {
    trainer.update(i / 30.0);
    if (!trainer.best_frame_due()) continue;
    trainer.draw(kSizes, 1, kNoBudget);
    trainer.keep_best_frame();
  }
  trainer.write_results_if_due();
  REQUIRE(trainer.session()->result());
  REQUIRE(trainer.result_files());

  const ExamResult written =
      result_from_json(read_file(trainer.result_files()->score), trainer.result_files()->score.string());
  Runner runner(*trainer.session()->study().scenario, trainer.session()->study().subject,
                trainer.session()->study().tissues);
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

TEST_CASE("the trainer keeps attempts in the database it was given, and of the user's own accord only those by hand") {
  const gl::HeadlessContext context;
  const Folder folder;
  const auto finish = [](Trainer& trainer) {
    trainer.open_from_options();
    trainer.finish_loading();
    for (int i = 0; i < 1000 && !trainer.result_files(); ++i) {
      trainer.update(i / 30.0);
      if (trainer.best_frame_due()) {
        trainer.draw(kSizes, 1, kNoBudget);
        trainer.keep_best_frame();
      }
      trainer.write_results_if_due();
    }
    REQUIRE(trainer.result_files());
    CHECK(trainer.problems().empty());
  };
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

TEST_CASE("where nothing changes nothing is drawn, and each change draws what it reaches") {
  const gl::HeadlessContext context;
  const Folder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  trainer.update(0.5);
  trainer.draw(kSizes, 1, kNoBudget);
  Pictures& pictures = trainer.pictures();
  const long drawn = pictures.drawn(), simulated = pictures.simulator_runs();
  REQUIRE(simulated > 0);
  for (int i = 0; i < 5; ++i) trainer.draw(kSizes, 1, kNoBudget);
  CHECK(pictures.drawn() == drawn);

  trainer.session()->console().gain_db = 3;
  trainer.draw(kSizes, 1, kNoBudget);
  CHECK(pictures.simulator_runs() == simulated + 1);  // display alone
  trainer.update(0.6);
  trainer.draw(kSizes, 1, kNoBudget);
  CHECK(pictures.simulator_runs() > simulated + 2);
  const long before_camera = pictures.simulator_runs(), all = pictures.drawn();
  pictures.camera.orbit(10, 0);
  trainer.draw(kSizes, 1, kNoBudget);
  CHECK(pictures.simulator_runs() == before_camera);
  CHECK(pictures.drawn() == all + 1);
}

TEST_CASE("a tracker with a calibration tells the probe's pose, and an old calibration warns") {
  const gl::HeadlessContext context;
  const Folder folder;
  Calibration calibration;
  calibration.tracker = {"replay", ""};
  // A sensor 5 mm behind the face, and a mannequin that lies as the patient does.
  calibration.tip = Dated<TipFit>{{}, 1767225600};
  calibration.face = Dated<FaceSetup>{{{Pose{glm::dmat3(1.0), {0, 5, 0}}, 0, 0}, "touch", 0}, 1767225600};
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

TEST_CASE("an OpenIGTLink client gets the picture that is on the screen, also one that stands when it connects") {
  const gl::HeadlessContext context;
  const Folder folder;
  constexpr PictureSizes small{240, 160, 160, 120};  // what the reader of messages keeps
  Options options = folder.options();
  {
    const igtl::Socket free_one = igtl::loopback_listener();
    options.igtl_server = std::to_string(igtl::bound_address(free_one).port());
  }
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  trainer.update(0);
  trainer.update(1);
  trainer.draw(small, 1, kNoBudget);
  igtl::RawPeer client = igtl::RawPeer::connected_to(parse_server_address(options.igtl_server));
  std::vector<std::uint8_t> grey;
  igtl::MessageReader reader([](const igtl::Header&) { return true; },
                             [&](const igtl::Header& header, igtl::ByteView body) {
                               constexpr std::size_t kHead = 72;  // of an IMAGE
                               if (header.type == "IMAGE") grey.assign(body.begin() + kHead, body.end());
                             });
  const auto draw_until_seen = [&] {
    for (grey.clear(); grey.empty();) {
      trainer.draw(small, 1, kNoBudget);
      reader.feed(client.receive());
    }
  };
  const auto on_screen = [&] {
    std::vector<std::uint8_t> pixels;
    for (const Rgba8& pixel : read_back(*trainer.pictures().ultrasound()).pixels) pixels.push_back(pixel[0]);
    return pixels;
  };
  draw_until_seen();
  CHECK(grey == on_screen());
  const std::vector<std::uint8_t> before = grey;
  trainer.session()->console().gain_db = 9;
  draw_until_seen();
  CHECK(grey == on_screen());
  CHECK(grey != before);
}

TEST_CASE("what cannot be opened is told of, and the session goes on as it was") {
  const gl::HeadlessContext context;
  const Folder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.problems().empty());
  const Session* const session = trainer.session();
  fs::create_directories(folder.path / "empty");
  fs::create_directories(folder.path / "broken");
  folder.file("broken/case.toml", "name = 3");

  std::string of_nobody = kTinyScenario;
  of_nobody.replace(of_nobody.find("\"tiny\""), 6, "\"nobody\"");

  const std::vector<std::pair<fs::path, std::string>> bad = {
      {folder.path / "missing.nii.gz", "no such file"},
      {folder.file("picture.jpg", "JFIF"), "does not open files of this kind"},
      {folder.file("cut.nii.gz", "\x1f\x8b not really"), "cut.nii.gz"},
      {folder.file("nothing.nrrd", ""), "empty"},
      {folder.path / "empty", "empty"},
      {folder.path / "broken", "case.toml"},
      {folder.file("typo.toml", "format = 1\ntitel = \"x\"\n"), "titel"},
      {folder.file("other_case.toml", of_nobody), "nobody"},
      {folder.file("words.igs.mha", "this is no sequence\n"), "words.igs.mha"},
  };
  for (const auto& [path, words] : bad) {
    CAPTURE(path.string());
    open_and_wait(trainer, path);
    REQUIRE(trainer.problems().size() == 1);
    CHECK(trainer.problems().front().find(words) != std::string::npos);
    trainer.problems().pop_front();
    CHECK(trainer.session() == session);
    trainer.update(0.1);
    trainer.draw(kSizes, 1, kNoBudget);
    CHECK(trainer.pictures().ultrasound() != nullptr);
  }
}

TEST_CASE("a CT that the device cannot hold is told of, and the patient on the screen stays there") {
  const gl::HeadlessContext context;
  const Folder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  trainer.update(0.5);
  trainer.draw(kSizes, 1, kNoBudget);
  const Pictures& pictures = trainer.pictures();
  const Session* const session = trainer.session();
  const long drawn = pictures.drawn();
  const auto pixels = [&] {
    return std::array{read_back(*pictures.ultrasound()).pixels, read_back(*pictures.slice()).pixels,
                      read_back(*pictures.volume()).pixels};
  };
  const auto before = pixels();
  GLint limit = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);

  if (std::uint64_t(limit) >= kMostVoxelsASide) {
    WARN("this device takes every CT that a file may hold");
    return;
  }

  // Few and thick voxels in the file, one a millimetre when they are insonated.
  constexpr int kVoxels = 600;
  open_and_wait(trainer, folder.file("long.mha", water(kVoxels, (limit + 50.0) / kVoxels)));
  REQUIRE(trainer.problems().size() == 1);
  const std::string told = trainer.problems().front();
  CAPTURE(told);
  // The volume on the card has a voxel of air at either end.
  for (const std::string& words : {std::string("long.mha"), std::to_string(limit - 2), std::string("crop")})
    CHECK(told.find(words) != std::string::npos);
  CHECK(trainer.session() == session);
  REQUIRE(pictures.ultrasound());
  CHECK((pixels() == before));
  trainer.draw(kSizes, 1, kNoBudget);
  CHECK(pictures.drawn() == drawn);  // nothing was lost that would have to be drawn again
  trainer.session()->console().gain_db = 6;
  trainer.draw(kSizes, 1, kNoBudget);
  CHECK((pixels()[0] != before[0]));
}

TEST_CASE("another log can be opened in the same session's place, another patient too") {
  const gl::HeadlessContext context;
  const Folder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  const fs::path second = folder.file("second.igs.mha", write_sequence(samples_of(2, 60, [](double) {
                                        return Pose{glm::dmat3(1.0), {0, 0, 30}};
                                      })));
  open_and_wait(trainer, second);
  REQUIRE(trainer.problems().empty());
  trainer.update(0);
  trainer.update(3);
  trainer.draw(kSizes, 1, kNoBudget);
  trainer.write_results_if_due();
  REQUIRE(trainer.session()->result());
  CHECK(trainer.session()->result()->provenance.log == "second.igs.mha");
  CHECK(trainer.result_files());

  INFO("a view that was made of one patient is none of another");
  trainer.session()->practise();
  trainer.update(3.1);
  trainer.guide().add({"made", "Made", "curvilinear", 140, {}, {"ball"}, Pose{}});
  const auto guided_to = [&] {
    std::vector<std::string> names;
    for (trainer.guide().next(*trainer.session()); const auto guiding = trainer.guide().now(*trainer.session());
         trainer.guide().next(*trainer.session()))
      names.push_back(guiding->view->name);
    return names;
  };
  CHECK(guided_to() == std::vector<std::string>{"ball", "bare", "made"});
  Case another = tiny_case();
  another.name = "Somebody else";
  write_case(folder.path / "another", another);
  open_and_wait(trainer, folder.path / "another");
  REQUIRE(trainer.problems().empty());
  CHECK(trainer.session()->study().subject.name == "Somebody else");
  CHECK(trainer.session()->holder() == Holder::learner);
  trainer.update(4);
  trainer.draw(kSizes, 1, kNoBudget);
  CHECK(trainer.pictures().ultrasound() != nullptr);
  CHECK(guided_to() == std::vector<std::string>{"ball", "bare"});
}

TEST_CASE("without a window there is nobody to answer a dialog: bad input passes through") {
  const gl::HeadlessContext context;
  const Folder folder;
  Options options = folder.options();
  options.headless = true;
  options.case_folder = folder.path / "missing";
  Trainer trainer(options);
  trainer.open_from_options();
  CHECK_THROWS_AS(trainer.finish_loading(), InputError);
}

TEST_CASE("a second attempt's report shows its own best frame, and none when the view was never held") {
  const gl::HeadlessContext context;
  const Folder folder;
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
        trainer.draw(kSizes, 1, kNoBudget);
        trainer.keep_best_frame();
      }
      trainer.write_results_if_due();
    }
    REQUIRE(trainer.result_files());
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
  CHECK_FALSE(shows_best(third));
  CHECK(third.find(none) != std::string::npos);
  CHECK_FALSE(trainer.best_frame());
}

TEST_CASE("an exam that counts is kept once for a learner, with the seed that drew it, also when it is left early") {
  const gl::HeadlessContext context;
  const Folder folder;
  Options options = folder.options();
  options.results = folder.path / "lab.db";
  options.learner = "L-07";
  options.tracker = "mouse:";
  options.exam = true;
  const auto start = [](Trainer& trainer) {
    trainer.open_from_options();
    trainer.finish_loading();
  };
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
      trainer.draw(kSizes, 1, kNoBudget);
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
  REQUIRE(database.attempts().size() == 1);
  CHECK(database.attempts()[0].learner == "L-07");
  CHECK(database.attempts()[0].complete);
  const auto seed_of = [&](std::int64_t number) {
    return result_from_json(database.read(number).score_json, "an attempt").provenance.seed;
  };
  CHECK(seed_of(1) != 0);  // drawn out of 2^32
  {
    Trainer again(options);
    start(again);
    CHECK_FALSE(again.session());
    CHECK_FALSE(again.loading());
    REQUIRE(again.problems().size() == 1);
    CHECK(again.problems().front().find("as attempt 1") != std::string::npos);
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
  REQUIRE(database.attempts().size() == 2);
  CHECK(seed_of(2) == 5);

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

TEST_CASE("a replay has no session, keeps nothing, and gives way to what is opened next") {
  const gl::HeadlessContext context;
  const Folder folder;
  Options options = folder.options();
  options.tracker.clear();
  options.replay.log = folder.path / "scan.igs.mha";
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.replay());
  CHECK_FALSE(trainer.session());
  trainer.update(0);
  trainer.draw(kSizes, 1, kNoBudget);
  REQUIRE(trainer.pictures().ultrasound());
  const Image<Rgba8> first = read_back(*trainer.pictures().ultrasound());
  trainer.replay()->toggle();
  for (int i = 0; i < 300; ++i) trainer.update(i / 30.0);
  CHECK(trainer.replay()->time_s() == trainer.replay()->run().duration_s());
  REQUIRE(trainer.replay()->run().result);
  trainer.draw(kSizes, 1, kNoBudget);
  CHECK(read_back(*trainer.pictures().ultrasound()).pixels != first.pixels);
  trainer.replay()->seek(0);
  trainer.draw(kSizes, 1, kNoBudget);
  CHECK(read_back(*trainer.pictures().ultrasound()).pixels == first.pixels);
  trainer.write_results_if_due();
  CHECK_FALSE(fs::exists(folder.path / "out"));
  CHECK_FALSE(fs::exists(folder.path / "data"));

  open_and_wait(trainer, folder.path / "scan.igs.mha");
  CHECK_FALSE(trainer.replay());
  CHECK(trainer.session());
}
