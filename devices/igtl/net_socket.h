#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <utility>

namespace insonate::igtl {

/// Owns a socket's descriptor and closes it when destroyed.
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

/// An address to connect to or listen at, IPv4 or IPv6.
struct Address {
  sockaddr_storage storage{};
  socklen_t size = 0;

  std::string text() const;  ///< "127.0.0.1" or "::1", without the port
  std::uint16_t port() const;
  bool is_loopback() const;
};

/// Returns the numeric address in `text`; its size is 0 if `text` is not one. Never queries the network.
Address numeric_address(const std::string& text, std::uint16_t port);

/// Starts to connect without waiting. The socket becomes writable when the attempt has ended, successful or not. Throws
/// std::system_error.
Socket begin_connect(const Address& address);

/// Returns how a begun connection ended: 0, or an errno.
int connect_error(const Socket& socket);

/// Listens without waiting; port 0 chooses a free one. Throws std::system_error.
Socket listen_on(const Address& address);

/// Limits the kernel's buffers of a connection, or of all connections that a listener accepts, in bytes per direction.
/// Linux doubles the values to cover its own overhead.
void limit_buffers(const Socket& socket, int send_bytes, int receive_bytes);

/// Returns the address to which a socket is bound.
Address bound_address(const Socket& socket);

}  // namespace insonate::igtl
