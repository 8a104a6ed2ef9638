// What the trainer draws, in how much detail and how often, and who else gets the picture.

#include <catch2/catch.hpp>

#include <chrono>
#include <optional>

#include "app/trainer/trainer.h"
#include "devices/igtl/igtl_reader.h"
#include "tests/app/trainer/trainer_folder.h"
#include "tests/devices/igtl/raw_peer.h"
#include "tests/gl/test_context.h"

using namespace insonate;
namespace fs = std::filesystem;

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
  CHECK(pictures.simulator_runs() == simulated + 2);  // display alone: fusion, and the filter of edges
  trainer.update(0.6);
  trainer.draw(kSizes);
  CHECK(pictures.simulator_runs() > simulated + 3);
  for (int look = 1; look < trainer.session()->machine().steering_angles; ++look) trainer.draw(kSizes);
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

TEST_CASE("a picture of few pixels has half of the samples, as the quality fast has, and of the fewest fewer lines") {
  const test::TestContext context;
  const TrainerFolder folder;
  const auto pixels = [&](Quality level, double share) {
    Options options = folder.options();
    options.quality = name_of(level);
    Trainer trainer(options);
    trainer.open_from_options();
    trainer.finish_loading();
    trainer.update(0.5);
    trainer.draw({400, 300, 160, 120}, {.quality = share});
    return read_back(*trainer.pictures().ultrasound()).pixels;
  };
  INFO("fast has three quarters of the pixels, whatever the share: 0.72 and 0.75 x 0.96 are as many");
  CHECK((pixels(Quality::balanced, 0.72) == pixels(Quality::fast, 0.96)));
  CHECK((pixels(Quality::balanced, 0.72) != pixels(Quality::exact, 0.72)));
  CHECK((pixels(Quality::balanced, 0.6) != pixels(Quality::fast, 0.8)));
}

TEST_CASE("a shader that builds as it is and not for other settings is reported, and the trainer goes on") {
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
