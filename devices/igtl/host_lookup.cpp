#include "devices/igtl/host_lookup.h"

#include <netdb.h>

#include <cstring>
#include <mutex>
#include <thread>

namespace insonate::igtl {

struct HostLookup::Shared {
  std::mutex mutex;
  std::optional<std::vector<Address>> addresses;
};

namespace {

std::vector<Address> ask(const std::string& host, std::uint16_t port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV | AI_ADDRCONFIG;
  addrinfo* found = nullptr;
  std::vector<Address> addresses;
  if (::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) return addresses;
  constexpr std::size_t kMax = 8;
  for (const addrinfo* one = found; one && addresses.size() < kMax; one = one->ai_next) {
    if (one->ai_addrlen > sizeof(sockaddr_storage)) continue;
    Address& address = addresses.emplace_back();
    std::memcpy(&address.storage, one->ai_addr, one->ai_addrlen);
    address.size = one->ai_addrlen;
  }
  ::freeaddrinfo(found);
  return addresses;
}

}  // namespace

HostLookup::HostLookup(const std::string& host, std::uint16_t port) : shared_(std::make_shared<Shared>()) {
  if (const Address numeric = numeric_address(host, port); numeric.size > 0) {
    shared_->addresses = {numeric};
    return;
  }
  std::thread([shared = shared_, host, port] {
    auto addresses = ask(host, port);
    const std::lock_guard lock(shared->mutex);
    shared->addresses = std::move(addresses);
  }).detach();
}

std::optional<std::vector<Address>> HostLookup::answer() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->addresses;
}

}  // namespace insonate::igtl
