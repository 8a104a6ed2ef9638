#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/igtl/net_socket.h"

namespace insonate::igtl {

/// Looks up the addresses of a host. A name is resolved on a detached thread, because the network may take any time to
/// answer, even longer than the caller lives.
class HostLookup {
public:
  HostLookup(const std::string& host, std::uint16_t port);

  /// Returns nothing until the answer has arrived, and an empty list if there is no such host.
  std::optional<std::vector<Address>> answer() const;

private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace insonate::igtl
