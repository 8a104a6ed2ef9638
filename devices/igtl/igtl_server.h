#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "devices/igtl/igtl_message.h"
#include "devices/igtl/net_socket.h"

namespace insonate::igtl {

/// Sends whole messages to any number of OpenIGTLink clients, from a thread of its own. Whoever publishes never waits
/// for the network, and a slow client slows nobody: of each stream it gets the latest message when it is ready for one,
/// and of events the last kMostEvents.
///
/// What clients send is read and thrown away. A client that takes nothing for long (kStuck_s unless told) while
/// something waits for it is let go.
class Server {
public:
  /// Of these the latest message counts, and a new client gets it at once.
  enum class Stream : std::size_t { status, pose, image };
  static constexpr std::size_t kStreams = 3;
  static constexpr std::size_t kMostClients = 64;
  static constexpr std::size_t kMostEvents = 64;
  static constexpr double kStuck_s = 10.0;

  /// Listens at once. Throws InputError when the address is not this computer's or the port is taken; `what` names the
  /// option in it.
  Server(const Address& address, const std::string& what, double stuck_s = kStuck_s);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  Address address() const { return address_; }
  std::size_t clients() const { return clients_.load(std::memory_order_relaxed); }

  /// The message is the stream's latest from now on.
  void publish(Stream stream, Bytes message);
  /// The stream has no latest message until the next.
  void forget(Stream stream);
  /// Every client gets it, unless it falls more than kMostEvents behind. Who connects later does not.
  void announce(Bytes event);

private:
  using Message = std::shared_ptr<const Bytes>;
  struct Client {
    Socket socket;
    Message sending;                              ///< null: ready for the next
    std::size_t sent = 0;                         ///< bytes of it
    std::array<std::uint64_t, kStreams> taken{};  ///< number of the last message of each stream
    std::uint64_t next_event = 0;
    double progress_s = 0;  ///< when it last took something or had nothing to take
  };

  void run();
  void wake();
  void accept_all(std::vector<Client>& clients);
  Message next_for(Client& client);
  bool send_to(Client& client);
  static bool ignore_what_it_says(const Client& client);

  const double stuck_s_;
  Address address_;
  Socket listener_;
  Socket woken_;  ///< an eventfd
  std::atomic<std::size_t> clients_{0};
  std::atomic<bool> ending_{false};

  std::mutex mutex_;  ///< held to move pointers, never while a socket is touched
  std::array<Message, kStreams> latest_;
  std::array<std::uint64_t, kStreams> numbers_{};  ///< how often each stream was published
  std::deque<Message> events_;
  std::uint64_t event_end_ = 0;  ///< number of the event that comes next

  std::jthread thread_;
};

}  // namespace insonate::igtl
