#include "devices/igtl/igtl_server.h"

#include "raw_peer.h"
#include <catch2/catch.hpp>
#include <igtlClientSocket.h>
#include <igtlMessageHeader.h>
#include <igtlTransformMessage.h>

#include <future>
#include <random>

#include "devices/igtl/igtl_reader.h"
#include "devices/registry.h"
#include "sim/core/input_error.h"
#include "tests/devices/live/scripted_source.h"

namespace insonate::igtl {
namespace {

Pose at_x(double x) {
  return {glm::dmat3(1.0), {x, 2, 3}};
}

bool eventually(const std::function<bool()>& holds) {
  for (const double limit_s = steady_now_s() + 60; steady_now_s() < limit_s;) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

/// Reads messages of a connection, whatever their kind.
struct Listening {
  explicit Listening(const Address& address) : peer(RawPeer::connected_to(address)) {}
  /// Until a message holds something; false when the server closes before.
  bool until(std::function<bool(const Header&, ByteView)> found) {
    found_ = std::move(found);
    for (holds_ = false; !holds_;) {
      const Bytes bytes = peer.receive();
      if (bytes.empty()) return false;
      reader_.feed(bytes);
    }
    return true;
  }
  RawPeer peer;
  std::vector<std::string> types;

private:
  // Lives as long as the connection: a portion may end in the middle of a message.
  MessageReader reader_{[](const Header&) { return true; },
                        [this](const Header& header, ByteView body) {
                          types.push_back(header.type);
                          holds_ = holds_ || found_(header, body);
                        }};
  std::function<bool(const Header&, ByteView)> found_;
  bool holds_ = false;
};

std::function<bool(const Header&, ByteView)> pose_at(float x) {
  return [x](const Header& header, ByteView body) {
    return header.type == "TRANSFORM" && (*parse_transform(body))[3][0] == double(x);
  };
}

/// Small kernel buffers, so that a client that reads nothing is stuck soon.
ServerLimits tight() {
  ServerLimits limits;
  limits.send_buffer = 4096;
  return limits;
}

/// More than the kernel's buffers hold on both sides, so that a client that does not read stays in the middle of it.
Bytes large_image(double x) {
  return make_image("Ultrasound", 0, Image<std::uint8_t>(1000, 1000), at_x(x), 1);
}

Bytes header_claiming(std::uint64_t body_bytes) {
  Bytes header = make_message("TRANSFORM", "Probe", 0, {});
  for (std::size_t i = 0; i < 8; ++i) header[42 + i] = std::uint8_t(body_bytes >> (56 - 8 * i));
  return header;
}

/// A server whose time a test sets, and a client that reads along.
struct Timed {
  std::atomic<double> now_s{100};
  Server server;
  Listening listener;
  explicit Timed(const ServerLimits& limits = tight())
      : server(numeric_address("127.0.0.1", 0), "--igtl-server", limits, [this] { return now_s.load(); }),
        listener(server.address()) {
    REQUIRE(eventually([&] { return server.clients() == 1; }));
  }
  /// Until the server has gone through all its clients, at the time that is set.
  void turn() {
    for (int i = 0; i < 2; ++i) {
      server.publish(Server::Stream::pose, make_transform("ProbeToRas", 0, at_x(++pose_)));
      REQUIRE(listener.until(pose_at(float(pose_))));
    }
  }

private:
  int pose_ = 0;
};

}  // namespace

TEST_CASE("who connects gets the latest of each stream at once, and events from then on") {
  Server server(numeric_address("127.0.0.1", 0), "--igtl-server");
  CHECK(server.address().port() != 0);
  server.announce(make_string("Event", 0, "before anybody came"));
  server.publish(Server::Stream::pose, make_transform("ProbeToRas", 0, at_x(1)));
  server.publish(Server::Stream::pose, make_transform("ProbeToRas", 0, at_x(2)));
  server.publish(Server::Stream::image, make_image("Ultrasound", 0, Image<std::uint8_t>(4, 4), at_x(2), 1));
  server.publish(Server::Stream::status, make_status("Exam", 0, {kStatusOk, "running"}));
  Listening client(server.address());
  REQUIRE(client.until([](const Header& header, ByteView) { return header.type == "IMAGE"; }));
  CHECK(client.types == std::vector<std::string>{"STATUS", "TRANSFORM", "IMAGE"});
  CHECK(server.clients() == 1);
  server.announce(make_string("Event", 0, "one"));
  server.announce(make_string("Event", 0, "two"));
  std::string texts;
  REQUIRE(client.until([&](const Header& header, ByteView body) {
    if (header.type == "STRING") texts += std::string(body.begin() + 4, body.end()) + ";";
    return texts.size() >= 8;
  }));
  CHECK(texts == "one;two;");
}

TEST_CASE("a client of Debian's library and our own receive the pose") {
  Server server(numeric_address("127.0.0.1", 0), "--igtl-server");
  server.publish(Server::Stream::pose, make_transform("ProbeToRas", 0, at_x(4.5)));
  auto socket = ::igtl::ClientSocket::New();
  REQUIRE(socket->ConnectToServer("127.0.0.1", server.address().port()) == 0);
  auto header = ::igtl::MessageHeader::New();
  header->InitPack();
  REQUIRE(std::size_t(socket->Receive(header->GetPackPointer(), header->GetPackSize())) == kHeaderBytes);
  header->Unpack();
  REQUIRE(std::string(header->GetDeviceType()) == "TRANSFORM");
  auto message = ::igtl::TransformMessage::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  REQUIRE(socket->Receive(message->GetPackBodyPointer(), message->GetPackBodySize()) > 0);
  REQUIRE(message->Unpack(1) & ::igtl::MessageHeader::UNPACK_BODY);
  ::igtl::Matrix4x4 matrix;
  message->GetMatrix(matrix);
  CHECK(matrix[0][3] == 4.5f);
  socket->CloseSocket();

  const auto tracker =
      open_tracker("igtl://127.0.0.1:" + std::to_string(server.address().port()) + "/ProbeToRas?frame=ras&filter=off");
  std::vector<ProbeSample> samples;
  REQUIRE(poll_until(*tracker, samples, [&] { return !samples.empty(); }));
  CHECK(samples.front().patient_from_probe.translation == glm::dvec3(-4.5, -2, 3));
}

TEST_CASE("a client that never reads and one that sends whole messages slow nobody") {
  // Nobody is let go meanwhile, however long this machine takes: the server's time stands still.
  Timed timed(ServerLimits{});
  const RawPeer sleeper = RawPeer::connected_to(timed.server.address());
  RawPeer talker = RawPeer::connected_to(timed.server.address());
  REQUIRE(eventually([&] { return timed.server.clients() == 3; }));
  for (int i = 1; i <= 40; ++i) {
    talker.send(make_image("CT", 0, Image<std::uint8_t>(100, 100), at_x(i), 1));
    timed.server.publish(Server::Stream::image, large_image(i));
    timed.turn();
  }
  CHECK(timed.server.clients() == 3);
}

TEST_CASE("a client that does not take a message in time is let go") {
  Timed timed;
  const RawPeer sleeper = RawPeer::connected_to(timed.server.address());
  REQUIRE(eventually([&] { return timed.server.clients() == 2; }));
  timed.server.publish(Server::Stream::image, large_image(1));
  timed.turn();
  timed.now_s = 109.9;
  timed.turn();
  CHECK(timed.server.clients() == 2);
  timed.now_s = 110;
  timed.turn();
  CHECK(timed.server.clients() == 1);
}

TEST_CASE("a client that begins a message and waits is let go, one that says nothing is not") {
  const Bytes message = make_transform("Probe", 0, at_x(1));
  const auto [begun, bytes] = GENERATE(table<const char*, std::size_t>({{"a header", 30}, {"a body", 70}}));
  INFO(begun);
  Timed timed;
  const RawPeer silent = RawPeer::connected_to(timed.server.address());
  RawPeer polite = RawPeer::connected_to(timed.server.address()), half = RawPeer::connected_to(timed.server.address());
  REQUIRE(eventually([&] { return timed.server.clients() == 4; }));
  polite.send(message);
  half.send(ByteView(message).first(bytes));
  timed.turn();
  timed.now_s = 109.9;
  timed.turn();
  CHECK(timed.server.clients() == 4);
  timed.now_s = 110;
  timed.turn();
  CHECK(timed.server.clients() == 3);
  while (!half.receive().empty()) continue;
}

TEST_CASE("a message that is not OpenIGTLink, or claims more than any message has, ends its client's connection") {
  Timed timed;
  std::mt19937 random(7);
  Bytes noise(3000);
  for (std::uint8_t& byte : noise) byte = std::uint8_t(random());
  for (const Bytes& bytes : {noise, header_claiming(1ull << 60), header_claiming(~0ull), Bytes(kHeaderBytes)}) {
    RawPeer peer = RawPeer::connected_to(timed.server.address());
    REQUIRE(eventually([&] { return timed.server.clients() == 2; }));
    peer.send(bytes);
    REQUIRE(eventually([&] { return timed.server.clients() == 1; }));
  }
  INFO("a claim that a message can have is believed, and takes no memory");
  timed.server.forget(Server::Stream::pose);
  RawPeer peer = RawPeer::connected_to(timed.server.address());
  Bytes begun = header_claiming(MessageReader::kMaxPassed);
  begun.resize(100'000);
  peer.send(begun);
  timed.turn();
  CHECK(timed.server.clients() == 2);
  CHECK(timed.server.bytes_held() == make_transform("ProbeToRas", 0, at_x(0)).capacity());
}

TEST_CASE("clients share the bytes of a message, and it is gone with the last of them") {
  Timed timed;
  std::vector<RawPeer> sleepers;
  for (int i = 0; i < 10; ++i) sleepers.push_back(RawPeer::connected_to(timed.server.address()));
  REQUIRE(eventually([&] { return timed.server.clients() == 11; }));
  const std::size_t image = large_image(1).capacity();
  timed.server.publish(Server::Stream::image, large_image(1));
  timed.turn();
  timed.server.forget(Server::Stream::pose);
  timed.server.forget(Server::Stream::image);
  // They are in the middle of it, and nobody else has it.
  REQUIRE(eventually([&] { return timed.server.bytes_held() == image; }));
  sleepers.clear();
  REQUIRE(eventually([&] { return timed.server.clients() == 1; }));
  CHECK(eventually([&] { return timed.server.bytes_held() == 0; }));
}

TEST_CASE("all that slow clients are in the middle of has a bound, and the client that is at it longest goes") {
  const std::size_t image = large_image(1).capacity();
  ServerLimits limits = tight();
  limits.sending_bytes = 3 * image + image / 2;
  Timed timed(limits);
  std::vector<RawPeer> slow;
  for (int i = 0; i < 3; ++i) {
    timed.now_s = 100 + i;
    timed.server.publish(Server::Stream::image, large_image(i));
    slow.push_back(RawPeer::connected_to(timed.server.address()));
    REQUIRE_FALSE(slow.back().receive().empty());
    timed.turn();
  }
  timed.server.forget(Server::Stream::pose);
  REQUIRE(eventually([&] { return timed.server.bytes_held() == 3 * image; }));
  CHECK(timed.server.clients() == 4);
  timed.now_s = 103;
  timed.server.publish(Server::Stream::image, large_image(3));
  slow.push_back(RawPeer::connected_to(timed.server.address()));
  REQUIRE_FALSE(slow.back().receive().empty());
  REQUIRE(eventually([&] { return timed.server.bytes_held() == 3 * image; }));
  timed.turn();
  CHECK(timed.server.clients() == 4);
  std::size_t got = 0;
  for (Bytes bytes; !(bytes = slow.front().receive()).empty();) got += bytes.size();
  CHECK(got < image);
}

TEST_CASE("who publishes never waits for the server's thread, and what it publishes meanwhile has a bound") {
  std::promise<void> go_on;
  std::shared_future<void> gone_on = go_on.get_future().share();
  std::atomic<bool> held_up{false};
  Server server(numeric_address("127.0.0.1", 0), "--igtl-server", tight(), [&] {
    held_up = true;
    gone_on.wait();
    return 0.0;
  });
  server.announce(make_string("Event", 0, "wakes the thread"));
  REQUIRE(eventually([&] { return held_up.load(); }));
  const Bytes event = make_string("Event", 0, "one"), image = large_image(1);
  for (int i = 0; i < 1000; ++i) {
    server.announce(make_string("Event", 0, "one"));
    if (i % 100 == 0) server.publish(Server::Stream::image, large_image(i));
  }
  const std::size_t first = make_string("Event", 0, "wakes the thread").capacity();
  CHECK(server.bytes_held() == first + image.capacity() + ServerLimits{}.events * event.capacity());
  CHECK(server.bytes_held() <= tight().bytes());
  go_on.set_value();
  CHECK(eventually([&] { return server.bytes_held() == image.capacity() + ServerLimits{}.events * event.capacity(); }));
}

TEST_CASE("a client that is far behind gets the newest events in their order") {
  Timed timed;
  Listening late(timed.server.address());
  REQUIRE(eventually([&] { return timed.server.clients() == 2; }));
  timed.server.publish(Server::Stream::image, large_image(1));
  timed.turn();  // `late` is in the middle of it
  const int events = 3 * int(ServerLimits{}.events) / 2;
  for (int i = 0; i < events; ++i) {
    timed.server.announce(make_string("Event", 0, std::to_string(i)));
    timed.turn();
  }
  std::vector<std::string> texts;
  REQUIRE(late.until([&](const Header& header, ByteView body) {
    if (header.type == "STRING") texts.emplace_back(body.begin() + 4, body.end());
    return !texts.empty() && texts.back() == std::to_string(events - 1);
  }));
  REQUIRE(texts.size() == ServerLimits{}.events);
  for (std::size_t i = 0; i < texts.size(); ++i)
    CHECK(texts[i] == std::to_string(std::size_t(events) - texts.size() + i));
}

TEST_CASE("no message is beyond the limits, the largest that a trainer sends is within them") {
  Server server(numeric_address("127.0.0.1", 0), "--igtl-server");
  CHECK_NOTHROW(
      server.publish(Server::Stream::image, make_image("Ultrasound", 0, Image<std::uint8_t>(1024, 1024), at_x(1), 1)));
  CHECK_NOTHROW(server.announce(make_string("Event", 0, std::string(100'000, 'x'))));
  CHECK_THROWS_AS(server.publish(Server::Stream::image, Bytes(ServerLimits{}.message_bytes + 1)), std::length_error);
  CHECK_THROWS_AS(server.announce(Bytes(ServerLimits{}.event_bytes + 1)), std::length_error);
}

TEST_CASE("who is late gets the latest pose, not all that were before") {
  Server server(numeric_address("127.0.0.1", 0), "--igtl-server");
  Listening late(server.address());
  REQUIRE(eventually([&] { return server.clients() == 1; }));
  constexpr int kPoses = 200000;  // some 20 MB, more than the sockets' buffers hold
  for (int i = 1; i <= kPoses; ++i) server.publish(Server::Stream::pose, make_transform("ProbeToRas", 0, at_x(i)));
  REQUIRE(late.until(pose_at(float(kPoses))));
  CHECK(late.types.size() < kPoses);
}

TEST_CASE("more clients than there is room for are turned away, and a place that was left is taken again") {
  Server server(numeric_address("127.0.0.1", 0), "--igtl-server");
  server.publish(Server::Stream::pose, make_transform("ProbeToRas", 0, at_x(1)));
  std::vector<RawPeer> peers;
  for (std::size_t i = 0; i < ServerLimits{}.clients; ++i) peers.push_back(RawPeer::connected_to(server.address()));
  REQUIRE(eventually([&] { return server.clients() == ServerLimits{}.clients; }));
  CHECK_FALSE(Listening(server.address()).until(pose_at(1)));
  CHECK(server.clients() == ServerLimits{}.clients);
  peers.clear();
  REQUIRE(eventually([&] { return server.clients() == 0; }));
  CHECK(Listening(server.address()).until(pose_at(1)));
}

TEST_CASE("a port that is taken is refused in words") {
  const Server server(numeric_address("127.0.0.1", 0), "--igtl-server");
  const std::string port = std::to_string(server.address().port());
  CHECK_THROWS_WITH(Server(server.address(), "--igtl-server"),
                    Catch::Contains("127.0.0.1, port " + port) && Catch::Contains("choose another port"));
}

}  // namespace insonate::igtl
