// Finds the fans of pictures that the simulator draws: of all probes, cut off, and with text and scales beside them.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sim/imaging/simulator.h"
#include "sim/registration/echo_seen.h"
#include "sim/registration/find_fan.h"
#include "sim/tissue/tissue.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_body.h"

using namespace insonate;

namespace {

/// A scanner's screen with the probe's pictures in it, in front of which the probe moves.
struct Screen {
  Probe probe;
  double depth_mm = 100;
  ImageGeometry geometry;
  std::vector<Image<std::uint8_t>> pictures;
  int left = 0, top = 0;  // of the picture in the screen

  Screen(const std::string& name, double depth, int width = 480, int height = 360)
      : probe(*find_probe(name)), depth_mm(depth) {
    const test::TestContext context;
    Settings settings = trainer_settings(probe.frequency_mhz, depth_mm);
    settings.image_width = width;
    settings.image_height = height;
    gl::Simulator simulator;
    simulator.set_volume(test::test_body(), read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
    simulator.set_probe(probe, depth_mm);
    simulator.set_settings(settings);
    std::vector<Rgba8> pixels(std::size_t(width) * std::size_t(height));
    for (int i = 0; i < 6; ++i) {
      simulator.set_pose(test::on_the_skin(4 * i - 10, 5, 3 * i - 8));
      simulator.image().read(GL_RGBA, GL_UNSIGNED_BYTE, pixels.data(), pixels.size() * sizeof(Rgba8));
      Image<std::uint8_t>& picture = pictures.emplace_back(width, height);
      std::ranges::transform(pixels, picture.pixels.begin(),
                             [](const Rgba8& p) { return p[3] > 0 ? p[0] : std::uint8_t(0); });
    }
    geometry = simulator.geometry();
  }

  // Puts the pictures on a larger dark screen.
  void widen(int margin_left, int margin_top, int width, int height) {
    left += margin_left;
    top += margin_top;
    for (Image<std::uint8_t>& picture : pictures) {
      Image<std::uint8_t> screen(width, height, 3);
      for (int y = 0; y < std::min(picture.height, height - margin_top); ++y)
        for (int x = 0; x < std::min(picture.width, width - margin_left); ++x)
          screen.at(x + margin_left, y + margin_top) = std::max<std::uint8_t>(3, picture.at(x, y));
      picture = std::move(screen);
    }
  }
  // Darkens all but a part of the screen, as a scanner's window does.
  void cut(int x0, int y0, int x1, int y1) {
    for (Image<std::uint8_t>& picture : pictures)
      for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
          if (x < x0 || x >= x1 || y < y0 || y >= y1) picture.at(x, y) = 0;
  }
  void fill(int x0, int y0, int x1, int y1, std::uint8_t grey) {
    for (Image<std::uint8_t>& picture : pictures)
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) picture.at(x, y) = grey;
  }
  // Lines of text whose letters have strokes two pixels wide.
  void write(int x, int y, int letters, int lines) {
    for (int line = 0; line < lines; ++line)
      for (int letter = 0; letter < letters; ++letter) {
        const int u = x + 9 * letter, v = y + 16 * line;
        fill(u, v, u + 2, v + 11, 230);
        fill(u, v, u + 6, v + 2, 230);
        fill(u, v + 5, u + 5, v + 7, 230);
      }
  }

  FanSearch search(std::size_t used = 6) const {
    EchoSeen seen;
    for (std::size_t i = 0; i < used; ++i) seen.add(pictures[i]);
    return find_fan(seen.mask(), glm::dvec2(geometry.mm_per_pixel));
  }
  // Checks that the probe was found. Both tolerances are in pixels of the screen.
  FoundFan check_found(double tolerance = 2, std::size_t used = 6, bool knows_depth = true) const {
    const FanSearch search = this->search(used);
    INFO(search.problem);
    REQUIRE(search.fan);
    const FoundFan& fan = *search.fan;
    INFO(description(fan) << "; a pixel is " << geometry.mm_per_pixel << " mm");
    const double mm = tolerance * geometry.mm_per_pixel;
    CHECK(fan.probe.kind == probe.kind);
    const glm::dvec2 face = geometry.pixel({0, 0}) + glm::dvec2(left, top);
    CHECK(fan.face_pixel.x == Approx(face.x).margin(tolerance));
    CHECK(fan.face_pixel.y == Approx(face.y).margin(tolerance));
    if (knows_depth) CHECK(fan.depth_mm == Approx(depth_mm).margin(mm));
    // Where the edges lie at the face and at the depth, which is what radius, angle and width are for.
    const glm::dvec2 edge = face_edge(probe), found = face_edge(fan.probe);
    CHECK(found.x == Approx(edge.x).margin(mm));
    CHECK(found.y == Approx(edge.y).margin(mm));
    if (probe.kind != ProbeKind::linear) {
      const double spread = depth_mm * std::tan(M_PI / 360 * probe.field_of_view_deg);
      CHECK(depth_mm * std::tan(M_PI / 360 * fan.probe.field_of_view_deg) == Approx(spread).margin(2 * mm));
    }
    return fan;
  }
};

}  // namespace

TEST_CASE("the fans of all probes are found from their pictures") {
  for (const auto& [name, depth_mm] :
       {std::pair("curvilinear", 110.0), std::pair("linear", 50.0), std::pair("phased", 110.0)}) {
    INFO(name);
    const Screen screen(name, depth_mm);
    CHECK(screen.check_found().shown > 0.97);
  }
}

TEST_CASE("text, a grey scale and a ruler beside the fan do not count") {
  for (const auto& [name, depth_mm] :
       {std::pair("curvilinear", 110.0), std::pair("linear", 50.0), std::pair("phased", 110.0)}) {
    INFO(name);
    Screen screen(name, depth_mm);
    screen.widen(90, 70, 700, 480);
    screen.write(8, 8, 30, 3);
    screen.write(600, 90, 9, 8);
    screen.fill(20, 120, 44, 330, 140);                                       // a grey scale
    for (int y = 80; y < 430; y += 10) screen.fill(580, y, 590, y + 1, 255);  // a ruler
    screen.check_found();
    // A single image shows no change, so what is solid and large enough may count; text may not.
    screen.fill(20, 120, 44, 330, 3);
    screen.check_found(2, 1);
  }
}

TEST_CASE("a fan that the image cuts off is found by the edges that are left") {
  Screen screen("curvilinear", 110);
  screen.cut(60, 0, 430, 330);
  const FoundFan fan = screen.check_found(3);
  CHECK(fan.shown < 0.95);
  CHECK(fan.clip[0] == Approx(60).margin(2));
  CHECK(fan.clip[2] == Approx(370).margin(4));
  CHECK(fan.clip[1] + fan.clip[3] == Approx(330).margin(2));
  Screen phased("phased", 110);
  phased.cut(40, 0, 480, 360);
  CHECK(phased.check_found(3).shown < 0.99);
}
