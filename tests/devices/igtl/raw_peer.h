#pragma once

#include <poll.h>

#include <stdexcept>

#include "devices/igtl/igtl_message.h"
#include "devices/igtl/net_socket.h"

namespace insonate::igtl {

/// The peer of a connection, which sends any bytes a test wants. Waits for up to a minute, then throws.
class RawPeer {
public:
  explicit RawPeer(Socket socket) : socket_(std::move(socket)) {}

  static RawPeer accepted_by(const Socket& listener) {
    wait_for(listener, POLLIN);
    return RawPeer(Socket(::accept(listener.get(), nullptr, nullptr)));
  }
  static RawPeer connected_to(const Address& address) {
    RawPeer peer(begin_connect(address));
    wait_for(peer.socket_, POLLOUT);
    return peer;
  }

  void send(ByteView bytes) {
    while (!bytes.empty()) {
      wait_for(socket_, POLLOUT);
      const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0) throw std::runtime_error("the other side has closed");
      bytes = bytes.subspan(std::size_t(sent));
    }
  }

  /// Returns what came; empty once the other side has closed the connection.
  Bytes receive() {
    wait_for(socket_, POLLIN);
    Bytes bytes(65536);
    const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
    bytes.resize(count > 0 ? std::size_t(count) : 0);
    return bytes;
  }

private:
  static void wait_for(const Socket& socket, short events) {
    pollfd waiting{socket.get(), events, 0};
    if (::poll(&waiting, 1, 60000) != 1) throw std::runtime_error("nothing happened on the socket");
  }
  Socket socket_;
};

inline Socket loopback_listener(std::uint16_t port = 0) {
  return listen_on(numeric_address("127.0.0.1", port));
}

}  // namespace insonate::igtl
