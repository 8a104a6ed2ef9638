// Sessions whose poses come over OpenIGTLink, and what clients get of one.

#include <catch2/catch.hpp>

#include <thread>

#include "app/pictures/igtl_feed.h"
#include "app/session/session.h"
#include "devices/igtl/igtl_source.h"
#include "devices/live/live_tracker.h"
#include "devices/live/steady_clock.h"
#include "devices/registry.h"
#include "sim/core/input_error.h"
#include "tests/devices/igtl/raw_peer.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

std::shared_ptr<const LoadedCase> tiny_loaded_case() {
  auto loaded_case = std::make_shared<LoadedCase>();
  loaded_case->subject = tiny_case();
  loaded_case->tissues = tiny_tissues();
  loaded_case->scenario = parse_scenario(kTinyScenario, "exam.toml");
  loaded_case->surroundings.start.translation = {0, 0, -40};
  return loaded_case;
}

/// A scan that finds the ball after some searching.
std::vector<ProbeSample> scan() {
  return samples_of(9, 60, [](double t) {
    const double off = 25 * std::exp(-t / 2) * std::sin(2 * t) + 3;
    return turned(10 * std::sin(t) * std::exp(-t / 3), {1, 0.4, 0}, {4 * std::sin(0.7 * t), 0.5, off});
  });
}

/// Advances as a window does until something holds; false after more than the slowest machine needs.
bool advance_until(Session& session, const std::function<bool()>& holds) {
  for (const double limit_s = steady_now_s() + 60; steady_now_s() < limit_s;) {
    session.advance(steady_now_s());
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

}  // namespace

TEST_CASE("an exam over OpenIGTLink gets the score of its log") {
  const auto loaded_case = tiny_loaded_case();
  const std::vector<ProbeSample> log = scan();
  Runner runner(*loaded_case->scenario, loaded_case->subject, loaded_case->tissues);
  runner.feed(log);
  runner.end();
  const ExamResult expected = runner.result();
  REQUIRE(expected.percent > 10);

  const igtl::Socket listener = igtl::loopback_listener();
  igtl::ClientRequest request;
  request.host = "127.0.0.1";
  request.port = igtl::bound_address(listener).port();
  request.sender_times = true;
  request.clock = igtl::SenderClock(1e9, 1e9);  // the log is sent faster than it was recorded
  Session session(loaded_case,
                  [&] { return std::make_unique<LiveTracker>(std::make_unique<igtl::ClientSource>(request)); });
  session.advance(steady_now_s());
  igtl::RawPeer sender = igtl::RawPeer::accepted_by(listener);
  for (const ProbeSample& sample : log)
    sender.send(igtl::make_transform("Probe", igtl::stamp_of(1e6 + sample.time_s), sample.patient_from_probe));
  REQUIRE(advance_until(session, [&] { return session.tracker_state().usable >= log.size() || session.result(); }));
  REQUIRE(advance_until(session, [&] { return session.result().has_value(); }));
  // A message has 24 bits of each number, so that poses differ by 1e-5 mm and times by 1e-9 s: marks are smooth in
  // both but where a limit is met.
  CHECK(session.result()->percent == Approx(expected.percent).margin(0.01));
  CHECK(session.result()->passed == expected.passed);
}

TEST_CASE("a session's picture stands still while its OpenIGTLink server is gone, and goes on by itself") {
  igtl::Socket listener = igtl::loopback_listener();
  const std::uint16_t port = igtl::bound_address(listener).port();
  Session session(tiny_loaded_case(), [&] { return open_tracker("igtl://127.0.0.1:" + std::to_string(port)); });
  session.advance(steady_now_s());
  const Pose before = turned(5, {1, 0, 0}, {1, 2, 3}), after = turned(6, {1, 0, 0}, {1, 2, 4});
  Pose shown;
  {
    igtl::RawPeer sender = igtl::RawPeer::accepted_by(listener);
    sender.send(igtl::make_transform("Probe", 0, before));
    REQUIRE(advance_until(session, [&] { return session.shown_pose().has_value(); }));
    shown = *session.shown_pose();
    // The sender ends in the middle of a message.
    sender.send(igtl::ByteView(igtl::make_transform("Probe", 0, turned(80, {0, 1, 0}, {90, 90, 90}))).first(100));
    listener = igtl::Socket();
  }
  REQUIRE(advance_until(session, [&] { return session.lost_for_s().has_value(); }));
  REQUIRE(advance_until(session, [&] { return session.tracker_state().condition == TrackerCondition::lost; }));
  REQUIRE(advance_until(session, [&] { return !session.tracker_state().problem.empty(); }));
  CHECK(*session.shown_pose() == shown);
  INFO("the exam's time goes on without its tracker");
  const double elapsed_s = session.runner()->live().elapsed_s;
  REQUIRE(advance_until(session, [&] { return session.runner()->live().elapsed_s > elapsed_s; }));

  listener = igtl::loopback_listener(port);
  REQUIRE(advance_until(session, [&] {
    pollfd waiting{listener.get(), POLLIN, 0};
    return ::poll(&waiting, 1, 0) == 1;
  }));
  igtl::RawPeer sender = igtl::RawPeer::accepted_by(listener);
  sender.send(igtl::make_transform("Probe", 0, after));
  REQUIRE(advance_until(session, [&] { return !(*session.shown_pose() == shown); }));
  CHECK(session.shown_pose()->translation.z == Approx(4));
  CHECK_FALSE(session.lost_for_s());
}

TEST_CASE("clients get pose, picture and events, and without clients no picture is wanted") {
  Session session(tiny_loaded_case(), [] { return open_tracker("mouse:"); });
  session.advance(0);
  IgtlFeed feed(igtl::numeric_address("127.0.0.1", 0));
  feed.publish(session);
  CHECK_FALSE(feed.wants_pictures());

  igtl::RawPeer client = igtl::RawPeer::connected_to(feed.server().address());
  while (!feed.wants_pictures()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  feed.publish(session);
  DrawnPicture picture;
  picture.grey = Image<std::uint8_t>(6, 4, 9);
  picture.geometry.mm_per_pixel = 0.5;
  feed.show(picture);
  session.freeze(true);
  session.advance(0.1);
  feed.publish(session);
  std::vector<std::string> seen;
  bool frozen = false, image = false, pose = false;
  igtl::MessageReader reader([](const igtl::Header&) { return true; },
                             [&](const igtl::Header& header, igtl::ByteView body) {
                               if (header.type == "STRING")
                                 frozen = frozen || std::string(body.begin() + 4, body.end()) == "frozen";
                               if (header.type == "IMAGE") image = body.size() == 72 + 24;
                               if (header.type != "TRANSFORM") return;
                               pose = true;
                               const auto matrix = igtl::parse_transform(body);
                               REQUIRE(matrix);
                               const glm::dvec3 face = session.shown_pose()->translation;
                               CHECK((*matrix)[3][0] == Approx(-face.x).margin(1e-4));
                               CHECK((*matrix)[3][1] == Approx(-face.y).margin(1e-4));
                               CHECK((*matrix)[3][2] == Approx(face.z).margin(1e-4));
                             });
  while (!(frozen && image && pose)) {
    const igtl::Bytes bytes = client.receive();
    REQUIRE_FALSE(bytes.empty());
    reader.feed(bytes);
  }
}

TEST_CASE("a large picture is thinned and stays where it is") {
  DrawnPicture picture;
  picture.grey = Image<std::uint8_t>(7, 5);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x) picture.grey.at(x, y) = std::uint8_t(10 * y + x);
  picture.geometry = {7, 5, 0.5, {-1.5, 2.0}};
  const DrawnPicture thin = thinned(picture, 12);
  CHECK(thin.grey.width == 4);
  CHECK(thin.grey.height == 3);
  CHECK(thin.grey.at(3, 2) == 46);
  CHECK(thin.geometry.mm_per_pixel == 1.0);
  CHECK(ras_from_picture(picture).translation == glm::dvec3(-0.0, -3.0, 0));
  CHECK(ras_from_picture(thin).translation == glm::dvec3(-0.0, -3.0, 0));
}

TEST_CASE("a server listens on loopback unless it is set otherwise") {
  CHECK(parse_server_address("18944").text() == "127.0.0.1");
  CHECK(parse_server_address("0.0.0.0:18945").text() == "0.0.0.0");
  CHECK(parse_server_address("0.0.0.0:18945").port() == 18945);
  CHECK(parse_server_address("[::1]:5").text() == "::1");
  for (const char* bad : {"", "0", "65536", "18944x", "1.2.3.4:", ":"})
    CHECK_THROWS_WITH(parse_server_address(bad),
                      Catch::Contains(std::string("'") + bad + "' has no port from 1 to 65535"));
  CHECK_THROWS_WITH(parse_server_address("host:1"),
                    Catch::Contains("'host:1' has no address in numbers before its port; write a port as in '18944'"));
}
