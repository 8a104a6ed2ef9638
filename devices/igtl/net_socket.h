#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <utility>

namespace insonate::igtl {

/// A socket's descriptor, closed at the end.
class Socket {
public:
  Socket() = default;
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~Socket();

  int get() const { return descriptor_; }
  explicit operator bool() const { return descriptor_ >= 0; }

private:
  int descriptor_ = -1;
};

/// Where to connect or listen, IPv4 or IPv6.
struct Address {
  sockaddr_storage storage{};
  socklen_t size = 0;

  std::string text() const;  ///< "127.0.0.1" or "::1", without the port
  std::uint16_t port() const;
  bool is_loopback() const;
};

/// An address in numbers; an empty one (size 0) when `text` is none. Never asks the network.
Address numeric_address(const std::string& text, std::uint16_t port);

/// Starts to connect without waiting; the socket turns writable when that ended, well or not. Throws std::system_error.
Socket begin_connect(const Address& address);

/// How a begun connection ended: 0, or an errno.
int connect_error(const Socket& socket);

/// Listens without waiting; port 0 takes a free one. Throws std::system_error.
Socket listen_on(const Address& address);

/// Limits what the kernel keeps of a connection, or of all that a listener accepts: so many bytes each way, of which
/// Linux takes twice as many for what lies around them.
void limit_buffers(const Socket& socket, int send_bytes, int receive_bytes);

/// Where a socket is bound.
Address bound_address(const Socket& socket);

}  // namespace insonate::igtl
