#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/igtl/igtl_message.h"
#include "devices/igtl/igtl_reader.h"
#include "devices/igtl/net_socket.h"
#include "devices/live/steady_clock.h"

namespace insonate::igtl {

/// What clients can cost a Server. The defaults are for a trainer in a lab's network.
struct ServerLimits {
  std::size_t clients = 64;                      ///< connections beyond it are closed at once
  std::size_t message_bytes = (1 << 20) + 1024;  ///< of one message: a picture of a million pixels
  std::size_t event_bytes = 66 * 1024;           ///< of one event: the longest text of a STRING
  std::size_t events = 64;                       ///< the newest are kept for clients that are behind
  std::size_t sending_bytes = 32 << 20;          ///< of all messages that clients are in the middle of
  double stuck_s = 10;                           ///< for a client to take a message, or to go on with its own
  int send_buffer = 256 * 1024;                  ///< bytes per connection; the kernel takes twice as much
  int receive_buffer = 16 * 1024;                ///< bytes per connection; the kernel takes twice as much

  /// Bounds Server::bytes_held(): what clients are at; of each stream the latest and the next, and one being published
  /// and one being replaced; of events those that are kept, those that come, and one of each kind on the move.
  std::size_t bytes() const { return sending_bytes + 8 * message_bytes + (2 * events + 2) * event_bytes; }
};

/// Sends whole messages to OpenIGTLink clients, from a thread of its own. The publisher never waits, neither for the
/// network nor for a lock. All clients share the bytes of a message, which its publisher encodes once.
///
/// A client costs its place, a share of one message, the kernel's buffers of its connection, and 58 bytes of a header.
/// With the default limits all messages together are at most 49 MiB, and the kernel's buffers 34 MiB. Nothing stays
/// when clients are gone but the latest message of each stream and the events.
///
/// - A slow client skips: of each stream it gets the latest message when it is ready for one, and of events the newest.
/// - A client that does not take a message whole within `stuck_s` is let go.
/// - If clients are in the middle of different messages with more than `sending_bytes` in all, the client that has been
///   at its message longest is let go.
/// - What clients send is passed over by its headers. A client is let go if it sends no OpenIGTLink, or claims a body
///   of more than MessageReader::kMostPassed, or is silent for `stuck_s` in the middle of a message. Nothing is
///   allocated by a claimed size.
///
///   Server server(numeric_address("127.0.0.1", 18944), "--igtl-server");
///   server.publish(Server::Stream::pose, make_transform("ProbeToRas", stamp, pose));  // each frame
class Server {
public:
  /// A stream's latest message counts, and a new client gets it at once.
  enum class Stream : std::size_t { status, pose, image };
  static constexpr std::size_t kStreams = 3;
  using Clock = std::function<double()>;  ///< s, asked from the server's thread

  /// Listens at once. Throws InputError when the address is not this computer's or the port is taken; `what` names the
  /// option in it.
  Server(const Address& address, const std::string& what, const ServerLimits& limits = {},
         Clock clock_s = steady_now_s);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  Address address() const { return address_; }
  std::size_t clients() const { return count_.load(std::memory_order_relaxed); }
  /// Bytes of all messages in memory, each counted once; at most ServerLimits::bytes().
  std::size_t bytes_held() const { return bytes_held_.load(std::memory_order_relaxed); }

  // The next three are for one thread, the publisher's. They throw std::length_error for a message beyond the limits.

  /// The message is the stream's latest from now on.
  void publish(Stream stream, Bytes message);
  /// The stream has no latest message until the next.
  void forget(Stream stream);
  /// Every client gets it, unless it falls more than `events` behind. Who connects later does not.
  void announce(Bytes event);

private:
  /// A message, shared by all who are sent it, or the news that a stream has none (no bytes).
  struct Message {
    Message(Bytes b, std::uint64_t n, std::atomic<std::size_t>& h);
    ~Message();
    Message(const Message&) = delete;
    Message& operator=(const Message&) = delete;
    const Bytes bytes;
    const std::uint64_t number;      ///< counts the stream's messages, or the events
    std::atomic<std::size_t>& held;  ///< counts the bytes while the message lives
  };
  using Shared = std::shared_ptr<const Message>;

  /// Room for one message between two threads, neither of which waits. What was not taken is replaced.
  class Slot {
  public:
    ~Slot() { delete message_.load(); }
    void put(std::unique_ptr<const Message> message) { delete message_.exchange(message.release()); }
    std::unique_ptr<const Message> take() { return std::unique_ptr<const Message>(message_.exchange(nullptr)); }

  private:
    std::atomic<const Message*> message_{nullptr};
  };

  struct Client {
    Socket socket;                                ///< closed: let go, to be removed
    Shared sending;                               ///< null: ready for the next
    std::size_t sent = 0;                         ///< bytes of it
    double begun_s = 0;                           ///< when it was begun
    std::array<std::uint64_t, kStreams> taken{};  ///< number of the last message of each stream
    std::uint64_t next_event = 0;
    MessageReader heard{[](const Header&) { return false; }, [](const Header&, ByteView) {}};
    double heard_s = 0;  ///< when it sent something last
  };

  // The publisher's thread.
  void wake();

  // The server's thread.
  void run();
  void collect();
  void accept_all();
  Shared next_for(Client& client) const;
  void begin_next(Client& client);
  void make_room_for(const Shared& message);
  void send_to(Client& client);
  void hear(Client& client) const;
  bool overdue(const Client& client) const;
  static void let_go(Client& client);

  const ServerLimits limits_;
  const Clock clock_s_;
  Address address_;
  Socket listener_;
  Socket woken_;  ///< an eventfd
  std::atomic<std::size_t> count_{0}, bytes_held_{0};
  std::atomic<bool> ending_{false};

  // From the publisher to the server's thread.
  std::array<Slot, kStreams> new_latest_;
  std::vector<Slot> new_events_;  ///< each event's place follows from its number; one that is late is replaced

  // The publisher's.
  std::array<std::uint64_t, kStreams> published_{};
  std::array<bool, kStreams> forgotten_{};
  std::uint64_t announced_ = 0;

  // The server's thread's.
  std::vector<Client> clients_;
  std::array<Shared, kStreams> latest_;
  std::deque<Shared> events_;    ///< by their numbers
  std::uint64_t event_end_ = 1;  ///< number of the event that comes next
  double now_s_ = 0;             ///< of the turn that it is at

  std::jthread thread_;
};

}  // namespace insonate::igtl
