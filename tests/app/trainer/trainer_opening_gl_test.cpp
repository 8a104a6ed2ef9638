// Files that the trainer opens or refuses.

#include <catch2/catch.hpp>

#include <array>
#include <functional>
#include <optional>

#include "app/trainer/trainer.h"
#include "devices/sequence/sequence.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/volume/volume_checks.h"
#include "tests/app/trainer/trainer_folder.h"
#include "tests/gl/test_context.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// A CT of water, 24 mm wide and high, with a voxel of -1 HU: one value alone, or none below 0, is refused.
std::string water(int voxels_along_x, double spacing_x_mm) {
  constexpr int kOthers = 24;
  return "ObjectType = Image\nNDims = 3\nDimSize = " + std::to_string(voxels_along_x) +
         " 24 24\nElementSpacing = " + std::to_string(spacing_x_mm) +
         " 1 1\nElementType = MET_SHORT\nElementDataFile = LOCAL\n\xff\xff" +
         std::string((std::size_t(voxels_along_x) * kOthers * kOthers - 1) * sizeof(short), '\0');
}

}  // namespace

TEST_CASE("what cannot be opened is reported, and the session goes on as it was") {
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
      {folder.file("words.igs.mha", "this is not a sequence\n"), "words.igs.mha"},
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

TEST_CASE("a CT that the device cannot hold is reported, and the patient on the screen stays there") {
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

  if (std::uint64_t(limit) >= kMaxVoxelsPerSide) {
    WARN("this device takes every CT that a file may hold");
    return;
  }

  // Few and thick voxels in the file, one a millimetre when they are insonated.
  constexpr int kVoxels = 600;
  open_and_wait(trainer, folder.file("long.mha", water(kVoxels, (limit + 50.0) / kVoxels)));
  REQUIRE(trainer.problems().size() == 1);
  const std::string problem = trainer.problems().front();
  CAPTURE(problem);
  // The volume on the card has a voxel of air at either end.
  for (const std::string& words : {std::string("long.mha"), std::to_string(limit - 2), std::string("crop")})
    CHECK(problem.find(words) != std::string::npos);
  CHECK(trainer.session() == session);
  REQUIRE(pictures.ultrasound());
  CHECK((pixels() == before));
  trainer.draw(kSizes);
  CHECK(pictures.drawn() == drawn);  // nothing was lost that would have to be drawn again
  trainer.session()->set(ActionKind::gain, 6);
  trainer.draw(kSizes);
  CHECK((pixels()[0] != before[0]));
}

TEST_CASE("an image without air is shown, with a word that it may be no CT") {
  const test::TestContext context;
  const TrainerFolder folder;
  Trainer trainer(folder.options());
  trainer.open_from_options();
  trainer.finish_loading();
  CHECK(trainer.take_notices().empty());
  open_and_wait(trainer, folder.file("water.mha", water(24, 1)));
  REQUIRE(trainer.session());
  CHECK(trainer.session()->loaded_case().subject.name == "water.mha");
  const std::vector<Notice> notices = trainer.take_notices();
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].text.find("water.mha holds no air") == 0);
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
  CtLook bones = trainer.preferences().ct;
  bones.grey = {2000, 400};
  trainer.adjust_ct_look(bones);
  Case another = tiny_case();
  another.name = "Somebody else";
  write_case(folder.path / "another", another);
  open_and_wait(trainer, folder.path / "another");
  REQUIRE(trainer.problems().empty());
  CHECK(trainer.session()->loaded_case().subject.name == "Somebody else");
  CHECK(trainer.preferences().ct.grey == WindowLevel());
  CHECK(trainer.session()->holder() == Holder::learner);
  trainer.update(4);
  trainer.draw(kSizes);
  CHECK(trainer.pictures().ultrasound() != nullptr);
  CHECK(guided_to() == std::vector<std::string>{"ball", "bare"});

  INFO("a log that names another patient is refused");
  const fs::path foreign = folder.file(
      "foreign.igs.mha", write_sequence(samples_of(2, 60, [](double) { return Pose{}; }),
                                        to_texts(ActionLog{{0, {Action{ActionKind::patient, {}, "somebody else"}}}})));
  open_and_wait(trainer, foreign);
  REQUIRE(trainer.problems().size() == 1);
  CHECK(trainer.problems()[0].find("it was recorded on 'somebody else'") != std::string::npos);
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
