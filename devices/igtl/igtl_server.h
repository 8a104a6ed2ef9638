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

/// Limits on the resources that clients of a Server can use. The defaults suit a trainer in a lab's network.
struct ServerLimits {
  std::size_t clients = 64;                          ///< further connections are closed at once
  std::size_t message_bytes = (1 << 20) + 1024;      ///< per message: a picture of a million pixels
  std::size_t event_bytes = std::size_t(66) * 1024;  ///< per event: the longest text of a STRING
  std::size_t events = 64;                           ///< newest events stored for clients that are behind
  std::size_t sending_bytes = 32 << 20;              ///< total of all messages that clients are in the middle of
  double stuck_s = 10;             ///< longest time for a client to receive a message, or to complete its own
  int send_buffer = 256 * 1024;    ///< bytes per connection; the kernel uses twice as much
  int receive_buffer = 16 * 1024;  ///< bytes per connection; the kernel uses twice as much

  /// Upper bound of Server::bytes_held(). It counts the messages that clients are receiving; for each stream the latest
  /// and the next message, plus one being published and one being replaced; and the stored and the waiting events, plus
  /// one of each in transit.
  std::size_t bytes() const { return sending_bytes + 8 * message_bytes + (2 * events + 2) * event_bytes; }
};

/// Sends whole messages to OpenIGTLink clients from its own thread. The publisher never waits, neither for the network
/// nor for a lock. All clients share the bytes of a message, which its publisher encodes once.
///
/// A client costs its slot, a share of one message, the kernel's buffers of its connection, and 58 bytes for a header.
/// With the default limits all messages together take at most 49 MiB, and the kernel's buffers 34 MiB. After the
/// clients have gone, only the latest message of each stream and the events stay in memory.
///
/// - A slow client skips messages. When it is ready for one, it gets the latest of each stream, and the newest events.
/// - A client that does not receive a message completely within `stuck_s` is disconnected.
/// - If clients are in the middle of different messages with more than `sending_bytes` in total, the client that has
///   been receiving its message longest is disconnected.
/// - The server skips what clients send, by the headers. It disconnects a client that sends anything other than
///   OpenIGTLink, that announces a body of more than MessageReader::kMaxPassed, or that is silent for `stuck_s` in the
///   middle of a message. No memory is allocated by an announced size.
///
///   Server server(numeric_address("127.0.0.1", 18944), "--igtl-server");
///   server.publish(Server::Stream::pose, make_transform("ProbeToRas", stamp, pose));  // each frame
class Server {
public:
  /// Only a stream's latest message matters, and a new client gets it at once.
  enum class Stream : std::size_t { status, pose, image };
  static constexpr std::size_t kStreams = 3;
  using Clock = std::function<double()>;  ///< s, called on the server's thread

  /// Listens at once. Throws InputError if the address is not one of this computer's or the port is in use. The error
  /// message names the option `what`.
  Server(const Address& address, const std::string& what, const ServerLimits& limits = {},
         Clock clock_s = steady_now_s);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  Address address() const { return address_; }
  std::size_t clients() const { return count_.load(std::memory_order_relaxed); }
  /// Returns the bytes of all messages in memory, each counted once; at most ServerLimits::bytes().
  std::size_t bytes_held() const { return bytes_held_.load(std::memory_order_relaxed); }

  // Only one thread, the publisher's, may call the next three. They throw std::length_error if a message exceeds the
  // limits.

  /// Makes the message the latest of the stream.
  void publish(Stream stream, Bytes message);
  /// Leaves the stream without a latest message until the next publish().
  void forget(Stream stream);
  /// Sends the event to every connected client, unless the client falls more than `events` behind. Clients that connect
  /// later do not get it.
  void announce(Bytes event);

private:
  /// A message that all its receivers share. Without bytes it means that the stream has no latest message.
  struct Message {
    Message(Bytes b, std::uint64_t n, std::atomic<std::size_t>& h);
    ~Message();
    Message(const Message&) = delete;
    Message& operator=(const Message&) = delete;
    const Bytes bytes;
    const std::uint64_t number;      ///< counts the messages of the stream, or the events
    std::atomic<std::size_t>& held;  ///< counts the message's bytes while it lives
  };
  using Shared = std::shared_ptr<const Message>;

  /// Holds one message between two threads, neither of which waits. A message that was not taken is replaced.
  class Slot {
  public:
    ~Slot() { delete message_.load(); }
    void put(std::unique_ptr<const Message> message) { delete message_.exchange(message.release()); }
    std::unique_ptr<const Message> take() { return std::unique_ptr<const Message>(message_.exchange(nullptr)); }

  private:
    std::atomic<const Message*> message_{nullptr};
  };

  struct Client {
    Socket socket;                                ///< closed: disconnected, to be removed
    Shared sending;                               ///< null: ready for the next message
    std::size_t sent = 0;                         ///< bytes of `sending` sent so far
    double begun_s = 0;                           ///< when sending began
    std::array<std::uint64_t, kStreams> taken{};  ///< number of the last message of each stream
    std::uint64_t next_event = 0;
    MessageReader heard{[](const Header&) { return false; }, [](const Header&, ByteView) {}};
    double heard_s = 0;  ///< when the client last sent something
  };

  // Called on the publisher's thread.
  void wake();

  // Called on the server's thread.
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

  // Passed from the publisher to the server's thread.
  std::array<Slot, kStreams> new_latest_;
  std::vector<Slot> new_events_;  ///< indexed by event number; an event that was not taken in time is replaced

  // Used by the publisher.
  std::array<std::uint64_t, kStreams> published_{};
  std::array<bool, kStreams> forgotten_{};
  std::uint64_t announced_ = 0;

  // Used by the server's thread.
  std::vector<Client> clients_;
  std::array<Shared, kStreams> latest_;
  std::deque<Shared> events_;    ///< sorted by number
  std::uint64_t event_end_ = 1;  ///< number of the next event
  double now_s_ = 0;             ///< time of the current iteration

  std::jthread thread_;
};

}  // namespace insonate::igtl
