#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>

#include "app/trainer/trainer.h"
#include "devices/calibration/calibration.h"
#include "devices/igtl/igtl_reader.h"
#include "devices/sequence/sequence.h"
#include "scenarios/result_json.h"
#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/volume/volume_checks.h"
#include "tests/app/trainer/trainer_folder.h"
#include "tests/devices/igtl/raw_peer.h"
#include "tests/gl/test_context.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// A CT of water, 24 mm wide and high, with a voxel of 1 HU: a CT of one value alone is refused.
std::string water(int voxels_along_x, double spacing_x_mm) {
  constexpr int kOthers = 24;
  return "ObjectType = Image\nNDims = 3\nDimSize = " + std::to_string(voxels_along_x) +
         " 24 24\nElementSpacing = " + std::to_string(spacing_x_mm) +
         " 1 1\nElementType = MET_SHORT\nElementDataFile = LOCAL\n\1" +
         std::string(std::size_t(voxels_along_x) * kOthers * kOthers * sizeof(short) - 1, '\0');
}

}  // namespace

TEST_CASE("the trainer replays a log, draws it, and leaves a report and the runner's score") {
  const test::TestContext context;
  const TrainerFolder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.session());
  for (int i = 0; i < 150; ++i) {
    trainer.update(i / 30.0);
    if (!trainer.best_frame_due()) continue;
    trainer.draw(kSizes);
    trainer.keep_best_frame();
  }
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

TEST_CASE("where nothing changes nothing is drawn, and each change draws what it reaches") {
  const test::TestContext context;
  const TrainerFolder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  trainer.update(0.5);
  trainer.draw(kSizes);
  Pictures& pictures = trainer.pictures();
  const long drawn = pictures.drawn(), simulated = pictures.simulator_runs();
  REQUIRE(simulated > 0);
  for (int i = 0; i < 5; ++i) trainer.draw(kSizes);
  CHECK(pictures.drawn() == drawn);

  trainer.session()->set(ActionKind::gain, 3);
  trainer.draw(kSizes);
  CHECK(pictures.simulator_runs() == simulated + 1);  // display alone
  trainer.update(0.6);
  trainer.draw(kSizes);
  CHECK(pictures.simulator_runs() > simulated + 2);
  const long before_camera = pictures.simulator_runs(), all = pictures.drawn();
  pictures.camera.orbit(10, 0);
  trainer.draw(kSizes);
  CHECK(pictures.simulator_runs() == before_camera);
  CHECK(pictures.drawn() == all + 1);
}

TEST_CASE("fewer pixels are drawn of a picture that changes, and never of one that is there already") {
  const test::TestContext context;
  const TrainerFolder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  trainer.update(0.5);
  constexpr PictureSizes kWide{400, 300, 160, 120};
  const Pictures& pictures = trainer.pictures();
  const auto width_at = [&](double quality) {
    trainer.draw(kWide, {.quality = quality});
    return pictures.ultrasound()->width();
  };
  CHECK(width_at(1) == 400);
  const long drawn = pictures.drawn();
  CHECK(width_at(0.75) == 400);
  CHECK(pictures.drawn() == drawn);
  trainer.session()->set(ActionKind::gain, 3);
  CHECK(width_at(0.75) == 300);
  CHECK(width_at(0.8) == 320);
  CHECK(width_at(0.7) == 320);
  trainer.update(0.6);  // the probe moves
  CHECK(width_at(0.7) == 280);
  trainer.session()->set(ActionKind::depth, trainer.session()->machine().depth_mm + 20);
  CHECK(width_at(0.65) == 260);

  INFO("what a picture is held against has all pixels");
  ReferenceView view;
  view.probe = "curvilinear";
  view.depth_mm = 100;
  const auto reference = trainer.pictures().reference_picture(view);
  REQUIRE(reference);
  CHECK(reference->width == 400);
  CHECK(reference->height == 300);
  CHECK(width_at(0.7) == 280);
}

TEST_CASE("a shader that builds as it is and not for other settings is told of, and the trainer goes on") {
  const test::TestContext context;
  const TrainerFolder folder;
  std::vector<std::string> files;
  const std::string scatter = gl::ShaderSources().text("imaging/scatter.comp", files);
  fs::create_directories(folder.path / "shaders");
  folder.file("shaders/imaging/scatter.comp", "#if FACE == 0\n#error not for linear probes\n#endif\n" + scatter);
  Options options = folder.options();
  options.shader_folder = folder.path / "shaders";
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  trainer.update(0.5);
  const auto choose = [&](const char* probe) { trainer.session()->choose_probe(probe); };
  choose("curvilinear");
  trainer.draw(kSizes);
  const auto pixels = read_back(*trainer.pictures().ultrasound()).pixels;
  CHECK(trainer.shader_problem().empty());

  choose("linear");
  trainer.draw(kSizes);
  CHECK(trainer.shader_problem().find("not for linear probes") != std::string::npos);
  choose("curvilinear");
  trainer.draw(kSizes);
  CHECK((read_back(*trainer.pictures().ultrasound()).pixels == pixels));

  INFO("once the file is mended the picture is drawn");
  folder.file("shaders/imaging/scatter.comp", scatter);
  fs::last_write_time(options.shader_folder / "imaging/scatter.comp",
                      fs::last_write_time(options.shader_folder / "imaging/scatter.comp") + std::chrono::seconds(2));
  trainer.update(1.5);
  CHECK(trainer.shader_problem().empty());
  choose("linear");
  trainer.draw(kSizes);
  CHECK(trainer.shader_problem().empty());
  CHECK((read_back(*trainer.pictures().ultrasound()).pixels != pixels));
}

TEST_CASE("the ultrasound is drawn at the quality that is asked for, balanced unless one is") {
  const test::TestContext context;
  const TrainerFolder folder;
  const auto ultrasound = [&](std::optional<Quality> quality) {
    Options options = folder.options();
    if (quality) options.quality = name_of(*quality);
    Trainer trainer(options);
    trainer.open_from_options();
    trainer.finish_loading();
    trainer.update(0.5);
    trainer.draw(kSizes);
    return read_back(*trainer.pictures().ultrasound());
  };
  const Image<Rgba8> plain = ultrasound({}), fast = ultrasound(Quality::fast), exact = ultrasound(Quality::exact);
  CHECK(plain.width == kSizes.ultrasound_width);
  CHECK(plain.pixels == ultrasound(Quality::balanced).pixels);
  CHECK(fast.width == plain.width * 3 / 4);
  CHECK(fast.height == plain.height * 3 / 4);
  CHECK(exact.width == plain.width);
  CHECK(exact.pixels != plain.pixels);  // of more samples
}

TEST_CASE("a tracker with a calibration tells the probe's pose, and an old calibration warns") {
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

TEST_CASE("an OpenIGTLink client gets the picture that is on the screen, also one that stands when it connects") {
  const test::TestContext context;
  const TrainerFolder folder;
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
  trainer.draw(small);
  igtl::RawPeer client = igtl::RawPeer::connected_to(parse_server_address(options.igtl_server));
  std::vector<std::uint8_t> grey;
  igtl::MessageReader reader([](const igtl::Header&) { return true; },
                             [&](const igtl::Header& header, igtl::ByteView body) {
                               constexpr std::size_t kHead = 72;  // of an IMAGE
                               if (header.type == "IMAGE") grey.assign(body.begin() + kHead, body.end());
                             });
  const auto draw_until_seen = [&] {
    for (grey.clear(); grey.empty();) {
      trainer.draw(small);
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
  trainer.session()->set(ActionKind::gain, 9);
  draw_until_seen();
  CHECK(grey == on_screen());
  CHECK(grey != before);
}

TEST_CASE("what cannot be opened is told of, and the session goes on as it was") {
  const test::TestContext context;
  const TrainerFolder folder;
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
    trainer.draw(kSizes);
    CHECK(trainer.pictures().ultrasound() != nullptr);
  }
}

TEST_CASE("a CT that the device cannot hold is told of, and the patient on the screen stays there") {
  const test::TestContext context;
  const TrainerFolder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  trainer.update(0.5);
  trainer.draw(kSizes);
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
  trainer.draw(kSizes);
  CHECK(pictures.drawn() == drawn);  // nothing was lost that would have to be drawn again
  trainer.session()->set(ActionKind::gain, 6);
  trainer.draw(kSizes);
  CHECK((pixels()[0] != before[0]));
}

TEST_CASE("another log can be opened in the same session's place, another patient too") {
  const test::TestContext context;
  const TrainerFolder folder;
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
  trainer.draw(kSizes);
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
  CHECK(trainer.session()->loaded_case().subject.name == "Somebody else");
  CHECK(trainer.session()->holder() == Holder::learner);
  trainer.update(4);
  trainer.draw(kSizes);
  CHECK(trainer.pictures().ultrasound() != nullptr);
  CHECK(guided_to() == std::vector<std::string>{"ball", "bare"});
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

TEST_CASE("without a window there is nobody to answer a dialog: bad input passes through") {
  const test::TestContext context;
  const TrainerFolder folder;
  Options options = folder.options();
  options.headless = true;
  options.case_folder = folder.path / "missing";
  Trainer trainer(options);
  trainer.open_from_options();
  CHECK_THROWS_AS(trainer.finish_loading(), InputError);
}

TEST_CASE("the trainer makes no patient for what it refuses without one") {
  const test::TestContext context;
  const TrainerFolder folder;
  struct Cache {
    fs::path path;
    explicit Cache(const fs::path& p) : path(p) {
      if (const char* set = std::getenv("XDG_CACHE_HOME")) before = set;
      setenv("XDG_CACHE_HOME", path.c_str(), 1);
    }
    ~Cache() { before ? setenv("XDG_CACHE_HOME", before->c_str(), 1) : unsetenv("XDG_CACHE_HOME"); }
    std::optional<std::string> before;
  } const cache(folder.path / "cache");
  const std::string log = read_file(folder.path / "scan.igs.mha"),
                    exam = read_file(assets_folder() / "scenarios" / "ruq_hepatorenal.toml");
  Options options;
  options.headless = true;
  options.out = folder.path / "out";
  options.tracker = "mouse:";
  const auto refused = [&](const Options& given, const std::string& words) {
    Trainer trainer(given);
    const auto load = [&] {
      trainer.open_from_options();
      trainer.finish_loading();
    };
    CHECK_THROWS_WITH(load(), Catch::Contains(words));
    CHECK_FALSE(fs::exists(cache.path / "insonate"));  // the graphics driver has a cache of its own beside it
  };
  const auto with = [&](const std::function<void(Options&)>& change) {
    Options changed = options;
    change(changed);
    return changed;
  };
  const auto tracked = [&](const std::string& uri) { return with([&](Options& o) { o.tracker = uri; }); };
  const auto replayed = [&](const char* name, const std::string& bytes) {
    return tracked("replay:" + folder.file(name, bytes).string());
  };
  refused(replayed("cut.igs.mha", log.substr(0, log.size() / 2)), "cut.igs.mha");
  std::string acts = log;
  const std::string frame = "Seq_Frame0001_";
  acts.insert(acts.find(frame), frame + "Actions = dance\n");
  refused(replayed("acts.igs.mha", acts), "dance");
  refused(tracked("replay:" + (folder.path / "scan.igs.mha").string() + "?loop=1"), "leave loop=1 out");
  refused(tracked("hydra:?handset=9"), "handset");
  refused(with([&](Options& o) {
            o.tracker = "hydra:";
            o.calibration = folder.file("bad.toml", "x");
          }),
          "bad.toml");
  refused(with([&](Options& o) { o.scenario = folder.file("bad_exam.toml", exam.substr(0, 300)); }), "bad_exam.toml");
  refused(with([&](Options& o) { o.mode = Mode::replay, o.replay.log = folder.file("bad.igs.mha", acts); }), "dance");

  const fs::path database = folder.path / "lab.db";
  Sitting begun;
  begun.learner = "L-01";
  begun.scenario_text = exam;
  ResultsDatabase::open_or_make(database).begin(begun, log);
  refused(with([&](Options& o) {
            o.mode = Mode::exam;
            o.learner = "L-01";
            o.results = database;
          }),
          "the exam was begun at");
}

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
