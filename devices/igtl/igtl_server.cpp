#include "devices/igtl/igtl_server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "sim/core/input_error.h"

namespace insonate::igtl {
namespace {

void check_size(std::size_t bytes, std::size_t most) {
  if (bytes > most)
    throw std::length_error("a message has " + std::to_string(bytes) + " bytes, more than " + std::to_string(most));
}

}  // namespace

Server::Message::Message(Bytes b, std::uint64_t n, std::atomic<std::size_t>& h)
    : bytes(std::move(b)), number(n), held(h) {
  held.fetch_add(bytes.capacity(), std::memory_order_relaxed);
}

Server::Message::~Message() {
  held.fetch_sub(bytes.capacity(), std::memory_order_relaxed);
}

Server::Server(const Address& address, const std::string& what, const ServerLimits& limits, Clock clock_s)
    : limits_(limits),
      clock_s_(std::move(clock_s)),
      woken_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      new_events_(limits.events) {
  try {
    listener_ = listen_on(address);
    limit_buffers(listener_, limits_.send_buffer, limits_.receive_buffer);  // its connections inherit these limits
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
  [[maybe_unused]] const ssize_t written = ::write(woken_.get(), &one, sizeof one);  // fails only if already woken
}

void Server::publish(Stream stream, Bytes message) {
  const std::size_t which = std::size_t(stream);
  check_size(message.capacity(), limits_.message_bytes);
  forgotten_[which] = false;
  new_latest_[which].put(std::make_unique<const Message>(std::move(message), ++published_[which], bytes_held_));
  wake();
}

void Server::forget(Stream stream) {
  const std::size_t which = std::size_t(stream);
  if (std::exchange(forgotten_[which], true)) return;
  new_latest_[which].put(std::make_unique<const Message>(Bytes(), ++published_[which], bytes_held_));
  wake();  // otherwise the message stays in memory until the next one
}

void Server::announce(Bytes event) {
  check_size(event.capacity(), limits_.event_bytes);
  const std::uint64_t number = ++announced_;
  new_events_[number % new_events_.size()].put(std::make_unique<const Message>(std::move(event), number, bytes_held_));
  wake();
}

void Server::collect() {
  for (std::size_t stream = 0; stream < kStreams; ++stream)
    if (Shared message = new_latest_[stream].take()) latest_[stream] = std::move(message);
  bool any = false;
  for (std::size_t i = 0; i < new_events_.size(); ++i) {
    Shared event = new_events_[(event_end_ + i) % new_events_.size()].take();
    if (!event) continue;
    any = true;
    events_.push_back(std::move(event));
    if (events_.size() > limits_.events) events_.pop_front();
  }
  if (!any) return;
  std::sort(events_.begin(), events_.end(), [](const Shared& a, const Shared& b) { return a->number < b->number; });
  event_end_ = events_.back()->number + 1;
}

Server::Shared Server::next_for(Client& client) const {
  for (const Shared& event : events_)
    if (event->number >= client.next_event) {
      client.next_event = event->number + 1;
      return event;
    }
  for (std::size_t stream = 0; stream < kStreams; ++stream) {
    const Shared& latest = latest_[stream];
    if (latest && std::exchange(client.taken[stream], latest->number) != latest->number && !latest->bytes.empty())
      return latest;
  }
  return nullptr;
}

void Server::begin_next(Client& client) {
  const Shared next = next_for(client);
  if (!next) return;
  make_room_for(next);
  client.sending = next;
  client.sent = 0;
  client.begun_s = now_s_;
}

void Server::make_room_for(const Shared& message) {
  for (;;) {
    std::set<Shared> sent{message};
    Client* longest = nullptr;
    for (Client& client : clients_) {
      if (!client.sending) continue;
      sent.insert(client.sending);
      if (!longest || client.begun_s < longest->begun_s) longest = &client;
    }
    std::size_t bytes = 0;
    for (const Shared& one : sent) bytes += one->bytes.capacity();
    if (bytes <= limits_.sending_bytes || !longest) return;
    let_go(*longest);
  }
}

void Server::let_go(Client& client) {
  client.socket = Socket();
  client.sending = nullptr;
}

void Server::send_to(Client& client) {
  // Some pieces, then another client.
  for (int piece = 0; piece < 16; ++piece) {
    if (!client.sending) begin_next(client);
    if (!client.sending) return;
    const Bytes& bytes = client.sending->bytes;
    const ssize_t count = ::send(client.socket.get(), bytes.data() + client.sent, bytes.size() - client.sent,
                                 MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0) return errno == EAGAIN || errno == EINTR ? void() : let_go(client);
    client.sent += std::size_t(count);
    if (client.sent == bytes.size()) client.sending = nullptr;
  }
}

void Server::hear(Client& client) const {
  std::array<std::uint8_t, 4096> bytes;
  const ssize_t count = ::recv(client.socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  client.heard_s = now_s_;
  if (count <= 0 || client.heard.feed(ByteView(bytes).first(std::size_t(count))) == MessageReader::Damage::not_igtl)
    let_go(client);
}

bool Server::overdue(const Client& client) const {
  return (client.sending && now_s_ - client.begun_s >= limits_.stuck_s) ||
         (client.heard.in_message() && now_s_ - client.heard_s >= limits_.stuck_s);
}

void Server::accept_all() {
  // Further connections are accepted in the next iteration.
  for (std::size_t turn = 0; turn < limits_.clients; ++turn) {
    Socket socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    // If no descriptor is free, the listener stays ready. The pause avoids a busy loop.
    if (!socket && (errno == EMFILE || errno == ENFILE)) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (!socket) return;
    if (clients_.size() == limits_.clients) continue;  // closed at once
    collect();                                         // events announced before it connected are not sent to it
    Client& client = clients_.emplace_back();
    client.socket = std::move(socket);
    client.next_event = event_end_;
  }
}

void Server::run() {
  std::vector<pollfd> waiting;
  while (!ending_) {
    waiting.assign({{woken_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}});
    for (const Client& client : clients_)
      waiting.push_back({client.socket.get(), short(client.sending ? POLLIN | POLLOUT : POLLIN), 0});
    // The timeout is for clients that are stuck: nothing happens on their sockets.
    ::poll(waiting.data(), waiting.size(), 1000);
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t emptied = ::read(woken_.get(), &count, sizeof count);
    collect();
    now_s_ = clock_s_();
    for (std::size_t i = 0; i < clients_.size(); ++i) {
      Client& client = clients_[i];
      if (client.socket && waiting[i + 2].revents & (POLLIN | POLLHUP | POLLERR)) hear(client);
      if (client.socket) send_to(client);
      if (client.socket && overdue(client)) let_go(client);
    }
    const auto removed = [this] { std::erase_if(clients_, [](const Client& client) { return !client.socket; }); };
    removed();
    if (waiting[1].revents & POLLIN) accept_all();
    // New clients have not been sent anything yet, and clients that received all their pieces may need more.
    for (Client& client : clients_)
      if (client.socket && !client.sending) begin_next(client);
    removed();
    count_ = clients_.size();
  }
}

}  // namespace insonate::igtl
