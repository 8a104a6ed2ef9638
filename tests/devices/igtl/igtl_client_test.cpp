#include "raw_peer.h"
#include <catch2/catch.hpp>

#include "devices/igtl/igtl_source.h"
#include "devices/live/live_tracker.h"
#include "devices/registry.h"
#include "tests/devices/live/scripted_source.h"

namespace insonate::igtl {
namespace {

Pose at_x(double x) {
  return {glm::dmat3(1.0), {x, 2, 3}};
}

/// A client of a listener of the test, polled until something holds.
struct Client {
  explicit Client(const Socket& listener, const std::string& rest = "")
      : tracker(open_tracker("igtl://127.0.0.1:" + std::to_string(bound_address(listener).port()) + rest +
                             (rest.find('?') == rest.npos ? "?" : "&") + "filter=off")) {
    tracker->poll(steady_now_s(), samples);
  }
  bool until(const std::function<bool()>& done) { return poll_until(*tracker, samples, done); }
  bool usable(std::uint64_t count) {
    return until([&] { return tracker->state().usable >= count; });
  }
  bool says(const std::string& words) {
    return until([&] { return tracker->state().problem.find(words) != std::string::npos; });
  }
  std::unique_ptr<Tracker> tracker;
  std::vector<ProbeSample> samples;
};

}  // namespace

TEST_CASE("a client takes the first transform that comes, or the one that is named") {
  const Socket listener = loopback_listener();
  Client first(listener), named(listener, "/StylusToTracker?frame=ras");
  RawPeer one = RawPeer::accepted_by(listener), other = RawPeer::accepted_by(listener);
  for (RawPeer* peer : {&one, &other}) {
    peer->send(make_transform("ProbeToTracker", 0, at_x(1)));
    peer->send(make_transform("StylusToTracker", 0, at_x(7)));
    peer->send(make_transform("ProbeToTracker", 0, at_x(2)));
  }
  REQUIRE(first.usable(2));
  REQUIRE(named.usable(1));
  REQUIRE(first.samples.size() >= 2);
  CHECK(first.samples[0].patient_from_probe == at_x(1));
  CHECK(first.samples[1].patient_from_probe == at_x(2));
  INFO("from RAS to LPS x and y change their signs");
  CHECK(named.samples[0].patient_from_probe.translation == glm::dvec3(-7, -2, 3));
  CHECK(named.samples[0].patient_from_probe.rotation == glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1));
}

TEST_CASE("a transform whose name says that it leads to RAS does, unless the address says otherwise") {
  const Socket listener = loopback_listener();
  Client by_name(listener), as_told(listener, "/ProbeToRas?frame=lps");
  RawPeer one = RawPeer::accepted_by(listener), other = RawPeer::accepted_by(listener);
  for (RawPeer* peer : {&one, &other}) peer->send(make_transform("ProbeToRas", 0, at_x(7)));
  REQUIRE(by_name.usable(1));
  REQUIRE(as_told.usable(1));
  CHECK(by_name.samples[0].patient_from_probe.translation == glm::dvec3(-7, -2, 3));
  CHECK(as_told.samples[0].patient_from_probe == at_x(7));
}

TEST_CASE("a client reports what is wrong: a name that never comes, a status, another protocol") {
  const Socket listener = loopback_listener();
  {
    Client client(listener, "/Probe");
    RawPeer peer = RawPeer::accepted_by(listener);
    REQUIRE(client.until([&] {
      peer.send(make_transform("Stylus", 0, at_x(1)));
      return client.tracker->state().problem.find("sends 'Stylus' but no transform 'Probe'") != std::string::npos;
    }));
    peer.send(make_status("", 0, {13, "the camera warms up"}));
    CHECK(client.says("reports: the camera warms up"));
    peer.send(make_transform("Probe", 0, at_x(1)));
    CHECK(client.usable(1));
  }
  Client client(listener);
  RawPeer peer = RawPeer::accepted_by(listener);
  const std::string web = "HTTP/1.1 400 Bad Request\r\nConnection: close\r\nContent-Type: text/plain\r\n\r\n";
  peer.send({reinterpret_cast<const std::uint8_t*>(web.data()), web.size()});
  CHECK(client.says("is not OpenIGTLink: check the port"));
}

TEST_CASE("whatever a server sends, the client lives, says so, and takes the next pose") {
  const Socket listener = loopback_listener();
  Client client(listener);
  {
    RawPeer peer = RawPeer::accepted_by(listener);
    INFO("damaged messages are left out");
    Bytes damaged = make_transform("Probe", 0, at_x(99));
    damaged.back() ^= 1;
    peer.send(damaged);
    CHECK(client.says("1 damaged messages"));
    INFO("a pose that is none is invalid");
    Pose mirror = at_x(5);
    mirror.rotation[0] *= -1.0;
    peer.send(make_transform("Probe", 0, mirror));
    CHECK(client.until([&] { return client.tracker->state().last_status == PoseStatus::invalid; }));
    INFO("a message may come byte by byte");
    for (const std::uint8_t byte : make_transform("Probe", 0, at_x(1))) peer.send(ByteView(&byte, 1));
    CHECK(client.usable(1));
    INFO("what is announced is not allocated");
    Bytes header = make_message("IMAGE", "endless", 0, {});
    header[45] = 0x10;  // 2^36 bytes
    peer.send(ByteView(header));
    CHECK(client.says("is not OpenIGTLink"));
  }
  {
    RawPeer peer = RawPeer::accepted_by(listener);
    peer.send(make_transform("Probe", 0, at_x(2)));
    CHECK(client.usable(2));
    INFO("half a message, and then the connection ends");
    peer.send(ByteView(make_transform("Probe", 0, at_x(77))).first(60));
  }
  CHECK(client.says("has closed the connection"));
  RawPeer peer = RawPeer::accepted_by(listener);
  peer.send(make_transform("Probe", 0, at_x(3)));
  CHECK(client.usable(3));
  for (const ProbeSample& sample : client.samples)
    if (sample.status == PoseStatus::ok) CHECK(sample.patient_from_probe.translation.x <= 3);
}

TEST_CASE("a server that is silent, ends and starts again is lost and found") {
  Socket listener = loopback_listener();
  const std::uint16_t port = bound_address(listener).port();
  Client client(listener);
  {
    RawPeer peer = RawPeer::accepted_by(listener);
    peer.send(make_transform("Probe", 0, at_x(1)));
    REQUIRE(client.usable(1));
    CHECK(client.until([&] { return client.tracker->state().last_status == PoseStatus::missing; }));
    CHECK(client.until([&] { return client.tracker->state().condition == TrackerCondition::lost; }));
    listener = Socket();
  }
  CHECK(client.says("is the OpenIGTLink server started there?"));
  listener = loopback_listener(port);
  RawPeer peer = RawPeer::accepted_by(listener);
  peer.send(make_transform("Probe", 0, at_x(2)));
  REQUIRE(client.usable(2));
  CHECK(client.tracker->state().condition == TrackerCondition::tracking);
  for (std::size_t i = 1; i < client.samples.size(); ++i)
    CHECK(client.samples[i].time_s > client.samples[i - 1].time_s);
}

TEST_CASE("what a server complains of is shown for a while, or until it says that all is well") {
  ClientRequest request;
  request.host = "there";
  ClientSource client(request);
  REQUIRE(client.replay_open({}, 1));
  const auto said = [&](const Bytes& message, double time_s) {
    LiveBatch batch;
    client.replay_read(message, time_s, batch);
    return batch.note;
  };
  CHECK(said(make_status("", 0, {13, "the camera warms up"}), 2) == "there:18944 reports: the camera warms up");
  CHECK(said({}, 2 + ClientSource::kStatusShown_s - 0.1) == "there:18944 reports: the camera warms up");
  CHECK(said({}, 2 + ClientSource::kStatusShown_s).find("reports") == std::string::npos);
  CHECK(said(make_status("", 0, {13, "again"}), 20) == "there:18944 reports: again");
  CHECK(said(make_status("", 0, {kStatusOk, ""}), 21).find("reports") == std::string::npos);
}

TEST_CASE("with the sender's times the steps between samples are those of the messages") {
  const Socket listener = loopback_listener();
  Client client(listener, "?time=sender");
  RawPeer peer = RawPeer::accepted_by(listener);
  // Steps of less than the clock's tolerance, as they are all sent at once.
  for (const double sent_s : {5000.0, 5000.002, 5000.008})
    peer.send(make_transform("Probe", stamp_of(sent_s), at_x(1)));
  INFO("a clock that is set is followed from where it stands then");
  peer.send(make_transform("Probe", stamp_of(90000), at_x(1)));
  REQUIRE(client.usable(4));
  const auto& samples = client.samples;
  // The sum of two times of thousands of seconds rounds to 1e-12 s.
  CHECK(samples[1].time_s - samples[0].time_s == Approx(0.002).margin(1e-9));
  CHECK(samples[2].time_s - samples[0].time_s == Approx(0.008).margin(1e-9));
  CHECK(samples[3].time_s > samples[2].time_s);
  CHECK(samples[3].time_s < samples[0].time_s + 60);
}

}  // namespace insonate::igtl
