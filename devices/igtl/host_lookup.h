#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/igtl/net_socket.h"

namespace insonate::igtl {

/// The addresses of a host. A name is asked for on a thread that nobody waits for, because the answer may take as long
/// as the network likes, and longer than whoever asked lives.
class HostLookup {
public:
  HostLookup(const std::string& host, std::uint16_t port);

  /// Empty until the answer is there; no addresses when there is no such host.
  std::optional<std::vector<Address>> answer() const;

private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace insonate::igtl
