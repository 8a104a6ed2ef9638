#include "devices/igtl/igtl_server.h"

#include "raw_peer.h"
#include <catch2/catch.hpp>
#include <igtlClientSocket.h>
#include <igtlMessageHeader.h>
#include <igtlTransformMessage.h>

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
  std::vector<PoseSample> samples;
  REQUIRE(poll_until(*tracker, samples, [&] { return !samples.empty(); }));
  CHECK(samples.front().patient_from_probe.translation == glm::dvec3(-4.5, -2, 3));
}

TEST_CASE("a client that never reads and clients that send anything slow nobody") {
  // Nobody is let go meanwhile, however long this machine takes.
  Server server(numeric_address("127.0.0.1", 0), "--igtl-server", 3600);
  const RawPeer sleeper = RawPeer::connected_to(server.address());
  RawPeer shouter = RawPeer::connected_to(server.address());
  Listening listener(server.address());
  REQUIRE(eventually([&] { return server.clients() == 3; }));
  // More than the sockets' buffers hold, so that the sleeper is full long before the end.
  const Image<std::uint8_t> picture(1000, 1000);
  for (int i = 1; i <= 40; ++i) {
    shouter.send(Bytes(1000, std::uint8_t(i)));
    server.publish(Server::Stream::image, make_image("Ultrasound", 0, picture, at_x(i), 1));
    server.publish(Server::Stream::pose, make_transform("ProbeToRas", 0, at_x(i)));
    REQUIRE(listener.until(pose_at(float(i))));
  }
  CHECK(server.clients() == 3);
}

TEST_CASE("a client that takes nothing for too long is let go") {
  Server server(numeric_address("127.0.0.1", 0), "--igtl-server", 0.05);
  const RawPeer sleeper = RawPeer::connected_to(server.address());
  REQUIRE(eventually([&] { return server.clients() == 1; }));
  const Image<std::uint8_t> picture(1000, 1000);
  REQUIRE(eventually([&] {
    server.publish(Server::Stream::image, make_image("Ultrasound", 0, picture, at_x(1), 1));
    return server.clients() == 0;
  }));
  server.publish(Server::Stream::pose, make_transform("ProbeToRas", 0, at_x(3)));
  CHECK(Listening(server.address()).until(pose_at(3)));
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
  for (std::size_t i = 0; i < Server::kMostClients; ++i) peers.push_back(RawPeer::connected_to(server.address()));
  REQUIRE(eventually([&] { return server.clients() == Server::kMostClients; }));
  CHECK_FALSE(Listening(server.address()).until(pose_at(1)));
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
