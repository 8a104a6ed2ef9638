// Images over OpenIGTLink with the poses of their times, from a server that the test is.

#include "devices/igtl/tracked_images.h"

#include "raw_peer.h"
#include <catch2/catch.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/igtl/igtl_reader.h"
#include "devices/live/steady_clock.h"

namespace insonate::igtl {
namespace {

constexpr double kFirst_s = 1700000000;  // the sender's clock, which is not ours

Pose pose_at(double time_s) {
  return {glm::dmat3(1.0), {0, 0, 100 * (time_s - kFirst_s)}};
}
Bytes transform_at(double time_s, const char* name = "ProbeToReference") {
  return make_transform(name, stamp_of(time_s), pose_at(time_s));
}
Bytes image_at(double time_s, std::uint8_t grey = 9) {
  return make_image("Image", stamp_of(time_s), Image<std::uint8_t>(8, 6, grey), pose_at(time_s), 0.5);
}

struct Served {
  Socket listener = loopback_listener();
  TrackedImages stream;
  std::vector<TrackedImage> images;
  std::unique_ptr<RawPeer> peer;
  std::chrono::time_point<std::chrono::steady_clock, std::chrono::duration<double>> begin =
      std::chrono::steady_clock::now() + std::chrono::milliseconds(150);
  double ahead_s = 0;  // of the clock, to come to an end of patience at once

  explicit Served(ImagePlace place = ImagePlace::by_transform, const std::string& rest = "/ProbeToReference")
      : stream("igtl://127.0.0.1:" + std::to_string(bound_address(listener).port()) + rest, place) {
    stream.poll(steady_now_s(), images);
    peer = std::make_unique<RawPeer>(RawPeer::accepted_by(listener));
  }
  /// Sends a message at its time, as servers do: stamps that run ahead of the clock would mean that a clock was set.
  void send(double time_s, const Bytes& message) {
    std::this_thread::sleep_until(begin + std::chrono::duration<double>(time_s - kFirst_s));
    peer->send(message);
  }
  void wait_for(const std::function<bool()>& done) {
    for (int i = 0; i < 2000 && !done(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      stream.poll(steady_now_s() + ahead_s, images);
    }
    CHECK(done());
  }
};

}  // namespace

TEST_CASE("each image gets the pose of its own time, whichever comes first") {
  Served served;
  served.send(kFirst_s, transform_at(kFirst_s));
  served.send(kFirst_s + 0.02, image_at(kFirst_s + 0.02));
  served.send(kFirst_s + 0.04, transform_at(kFirst_s + 0.04));
  served.send(kFirst_s + 0.04, image_at(kFirst_s + 0.04));
  served.send(kFirst_s + 0.05, image_at(kFirst_s + 0.05));
  served.send(kFirst_s + 0.08, transform_at(kFirst_s + 0.08));
  served.wait_for([&] { return served.images.size() == 3; });
  for (std::size_t i = 0; i < 3; ++i) {
    const double time_s = kFirst_s + (i == 0 ? 0.02 : i == 1 ? 0.04 : 0.05);
    // Stamps are exact to less than a microsecond.
    CHECK(served.images[i].sweep_from_probe.translation.z == Approx(pose_at(time_s).translation.z).margin(0.01));
  }
  CHECK(served.stream.received() == 3);
  CHECK(served.stream.unplaced() == 0);
  CHECK(served.stream.problem().empty());
}

TEST_CASE("an image between poses that are far apart, or before the first, is left out") {
  Served served;
  served.send(kFirst_s - 0.1, image_at(kFirst_s - 0.1));
  served.send(kFirst_s, transform_at(kFirst_s));
  served.send(kFirst_s + 0.2, image_at(kFirst_s + 0.2));
  served.send(kFirst_s + 0.4, transform_at(kFirst_s + 0.4));
  served.wait_for([&] { return served.stream.unplaced() == 2; });
  CHECK(served.images.empty());
}

TEST_CASE("at most 32 images wait for a pose") {
  Served served;
  const double now_s = steady_now_s();  // stands still, so that no image has waited too long
  for (std::uint64_t sent = 10; sent <= 40; sent += 10) {
    for (int i = 0; i < 10; ++i) served.peer->send(image_at(kFirst_s));
    for (int i = 0; i < 2000 && served.stream.received() < sent; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      served.stream.poll(now_s, served.images);
    }
    served.stream.poll(now_s, served.images);
    CHECK(served.stream.unplaced() == (sent < 40 ? 0 : 8));
  }
  CHECK(served.images.empty());
}

TEST_CASE("images that carry their own place need no transform") {
  Served served(ImagePlace::by_image, "?frame=ras");
  served.peer->send(image_at(kFirst_s));
  served.peer->send(image_at(kFirst_s + 0.1));
  served.wait_for([&] { return served.images.size() == 2; });
  CHECK(served.images[1].frame_from_pixel[3].z == Approx(10));
  CHECK(served.images[1].frame_from_pixel[0].x == Approx(-0.5));  // turned from RAS to LPS
  served.ahead_s = 4;
  served.peer->send(image_at(kFirst_s + 0.2));
  served.wait_for([&] { return served.images.size() == 3; });
  CHECK(served.stream.problem().empty());
}

TEST_CASE("a stream that lacks something says what, in a sentence") {
  const auto said = [](Served& served, const std::string& sentence) {
    INFO(served.stream.problem());
    CHECK(served.stream.problem().find(sentence) != std::string::npos);
    CHECK(served.stream.problem().ends_with("."));
  };
  SECTION("images") {
    Served served;
    served.peer->send(transform_at(kFirst_s));
    served.ahead_s = 4;
    served.wait_for([&] { return !served.stream.problem().empty(); });
    said(served, "sends no IMAGE: add the ultrasound");
  }
  SECTION("transforms") {
    Served served;
    served.ahead_s = 4;
    served.peer->send(image_at(kFirst_s));
    served.wait_for([&] { return served.stream.received() == 1 && !served.stream.problem().empty(); });
    said(served, "sends images, but no usable TRANSFORM: add that of the probe");
  }
  SECTION("the transform that was named") {
    Served served;
    served.peer->send(transform_at(kFirst_s, "StylusToReference"));
    served.peer->send(image_at(kFirst_s));
    served.wait_for([&] { return !served.stream.problem().empty(); });
    said(served, "sends 'StylusToReference' but no transform 'ProbeToReference'");
  }
  SECTION("transforms often enough") {
    Served served;
    for (double time_s = kFirst_s; time_s < kFirst_s + TrackedImages::kMissing_s + 0.7; time_s += 0.3) {
      served.send(time_s, transform_at(time_s));
      served.stream.poll(steady_now_s(), served.images);
      served.send(time_s + 0.15, image_at(time_s + 0.15));
      served.stream.poll(steady_now_s(), served.images);
    }
    CHECK(served.images.empty());
    said(served, "whose times do not fit: let one clock stamp both, with a transform every 0.1 s");
  }
  SECTION("a size that can be used") {
    Served served;
    Bytes wrong = image_at(kFirst_s);
    const Bytes body(wrong.begin() + kHeaderBytes, wrong.end() - 1);
    served.peer->send(make_message("IMAGE", "Image", 1, body));
    served.wait_for([&] { return !served.stream.problem().empty(); });
    said(served, "has 47 bytes for 8 x 6 x 1 pixels of 1.");
    served.peer->send(make_message("IMAGE", "Image", 1, Bytes(MessageReader::kMaxKeptWithImages + 1, 7)));
    served.wait_for([&] { return served.stream.problem().find("16 MiB") != std::string::npos; });
    said(served, "has more than 16 MiB.");
  }
  SECTION("a server") {
    CHECK_THROWS_WITH(TrackedImages("mouse:", ImagePlace::by_transform),
                      Catch::Contains("only an OpenIGTLink server sends images with the poses"));
  }
}

}  // namespace insonate::igtl
