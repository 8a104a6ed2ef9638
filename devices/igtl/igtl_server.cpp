#include "devices/igtl/igtl_server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>

#include "devices/live/steady_clock.h"
#include "sim/core/input_error.h"

namespace insonate::igtl {

Server::Server(const Address& address, const std::string& what, double stuck_s)
    : stuck_s_(stuck_s), woken_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  try {
    listener_ = listen_on(address);
    address_ = bound_address(listener_);
  } catch (const std::system_error& error) {
    throw InputError(what, "",
                     "nobody can listen at " + address.text() + ", port " + std::to_string(address.port()) + ": " +
                         error.code().message(),
                     "choose another port, or end the program that has it");
  }
  thread_ = std::jthread([this] { run(); });
}

Server::~Server() {
  ending_ = true;
  wake();
}

void Server::wake() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(woken_.get(), &one, sizeof one);  // full means woken already
}

void Server::publish(Stream stream, Bytes message) {
  auto shared = std::make_shared<const Bytes>(std::move(message));
  {
    const std::lock_guard lock(mutex_);
    latest_[std::size_t(stream)].swap(shared);
    ++numbers_[std::size_t(stream)];
  }
  wake();
}

void Server::forget(Stream stream) {
  const std::lock_guard lock(mutex_);
  latest_[std::size_t(stream)] = nullptr;
}

void Server::announce(Bytes event) {
  auto shared = std::make_shared<const Bytes>(std::move(event));
  {
    const std::lock_guard lock(mutex_);
    events_.push_back(std::move(shared));
    ++event_end_;
    if (events_.size() > kMostEvents) events_.pop_front();
  }
  wake();
}

Server::Message Server::next_for(Client& client) {
  client.sent = 0;
  const std::lock_guard lock(mutex_);
  const std::uint64_t oldest = event_end_ - events_.size();
  client.next_event = std::max(client.next_event, oldest);
  if (client.next_event < event_end_) return events_[std::size_t(client.next_event++ - oldest)];
  for (std::size_t stream = 0; stream < kStreams; ++stream)
    if (std::exchange(client.taken[stream], numbers_[stream]) != numbers_[stream] && latest_[stream])
      return latest_[stream];
  return nullptr;
}

bool Server::send_to(Client& client) {
  // Some pieces and then somebody else's turn.
  for (int piece = 0; piece < 16; ++piece) {
    if (!client.sending) client.sending = next_for(client);
    if (!client.sending) {
      client.progress_s = steady_now_s();
      return true;
    }
    const ssize_t count = ::send(client.socket.get(), client.sending->data() + client.sent,
                                 client.sending->size() - client.sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0) return (errno == EAGAIN || errno == EINTR) && steady_now_s() - client.progress_s < stuck_s_;
    client.progress_s = steady_now_s();
    client.sent += std::size_t(count);
    if (client.sent == client.sending->size()) client.sending = nullptr;
  }
  return true;
}

bool Server::ignore_what_it_says(const Client& client) {
  std::array<char, 4096> ignored;
  const ssize_t count = ::recv(client.socket.get(), ignored.data(), ignored.size(), MSG_DONTWAIT);
  return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
}

void Server::accept_all(std::vector<Client>& clients) {
  for (;;) {
    Socket socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    // Without a descriptor to spare the listener stays ready: no reason to ask it all the time.
    if (!socket && (errno == EMFILE || errno == ENFILE)) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (!socket) return;
    if (clients.size() == kMostClients) continue;  // closed at once
    Client& client = clients.emplace_back();
    client.socket = std::move(socket);
    client.progress_s = steady_now_s();
    const std::lock_guard lock(mutex_);
    client.next_event = event_end_;
  }
}

void Server::run() {
  std::vector<Client> clients;
  std::vector<pollfd> waiting;
  while (!ending_) {
    waiting.assign({{woken_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}});
    for (const Client& client : clients)
      waiting.push_back({client.socket.get(), short(client.sending ? POLLIN | POLLOUT : POLLIN), 0});
    // The pause is for clients that are stuck: nothing happens on their sockets.
    ::poll(waiting.data(), waiting.size(), 1000);
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t emptied = ::read(woken_.get(), &count, sizeof count);
    for (std::size_t i = clients.size(); i-- > 0;) {
      const bool spoke = waiting[i + 2].revents & (POLLIN | POLLHUP | POLLERR);
      if ((spoke && !ignore_what_it_says(clients[i])) || !send_to(clients[i]))
        clients.erase(clients.begin() + std::ptrdiff_t(i));
    }
    if (waiting[1].revents & POLLIN) accept_all(clients);
    clients_ = clients.size();
    // Whoever came in has not been sent anything yet, and who had all its pieces may want more.
    for (Client& client : clients)
      if (!client.sending) client.sending = next_for(client);
  }
}

}  // namespace insonate::igtl
