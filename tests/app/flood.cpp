// Clients of an OpenIGTLink server that mean no good, on loopback, for soak tests of a trainer's --igtl-server:
//   flood PORT CLIENTS SECONDS SEED
// The clients take turns in what they do: read all they get; read nothing; send random bytes; send half a header and
// wait; send a header that claims a body of 2^60 bytes. A client that the server turns away or closes comes back after
// 0.2 s. Prints what happened. Exits with 1 if no client could connect in the last 5 s, or if what a reading client got
// was damaged.

#include <poll.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "devices/igtl/igtl_reader.h"
#include "devices/igtl/net_socket.h"
#include "devices/live/steady_clock.h"

namespace insonate::igtl {
namespace {

constexpr double kPause_s = 0.2, kSilent_s = 5;
constexpr std::size_t kPortion = 16384;

struct Counts {
  long connections = 0, closed = 0, messages = 0, damaged = 0;
  double read_bytes = 0, sent_bytes = 0;
  double connected_s = 0;  ///< when a client connected last
};

enum class Habit { reads, sleeps, shouts, begins, boasts };
constexpr std::size_t kHabits = 5;

class Client {
public:
  Client(Habit habit, std::uint32_t seed, Counts& counts) : habit_(habit), random_(seed), counts_(counts) {}

  const Socket& socket() const { return socket_; }
  short waits_for() const {
    if (!connected_ || !to_send_.empty()) return POLLOUT | (habit_ == Habit::sleeps ? 0 : POLLIN);
    return habit_ == Habit::sleeps ? 0 : POLLIN;
  }

  void connect(const Address& server, double now_s) {
    if (socket_ || now_s < again_s_) return;
    try {
      socket_ = begin_connect(server);
    } catch (const std::exception&) {
      close(now_s);
    }
  }

  /// @param events  what poll() found
  void turn(short events, double now_s) {
    if (!connected_ && events) begin(now_s);
    if (socket_ && events & POLLOUT) send(now_s);
    if (socket_ && events & (POLLIN | POLLHUP | POLLERR)) read(now_s);
  }

private:
  void begin(double now_s) {
    if (connect_error(socket_) != 0) return close(now_s);
    connected_ = true;
    ++counts_.connections;
    counts_.connected_s = now_s;
    reader_ = std::make_unique<MessageReader>([](const Header&) { return true; },
                                              [this](const Header&, ByteView) { ++counts_.messages; });
    Bytes header = make_message("TRANSFORM", "Flood", 0, {});
    constexpr std::size_t kBodySizeAt = 42;  // a number of 8 bytes, the largest first
    if (habit_ == Habit::begins) to_send_.assign(header.begin(), header.begin() + kHeaderBytes / 2);
    if (habit_ == Habit::boasts) {
      header[kBodySizeAt] = 0x10;
      to_send_ = header;
      to_send_.resize(kPortion);
    }
    if (habit_ == Habit::shouts) shout();
  }

  void shout() {
    to_send_.resize(kPortion);
    for (std::uint8_t& byte : to_send_) byte = std::uint8_t(random_());
  }

  void send(double now_s) {
    if (to_send_.empty()) return;
    const ssize_t count = ::send(socket_.get(), to_send_.data(), to_send_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0) return errno == EAGAIN ? void() : close(now_s);
    counts_.sent_bytes += double(count);
    to_send_.erase(to_send_.begin(), to_send_.begin() + count);
    if (to_send_.empty() && habit_ == Habit::shouts) shout();
  }

  void read(double now_s) {
    Bytes bytes(4 * kPortion);
    const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count < 0 && errno == EAGAIN) return;
    if (count <= 0) return close(now_s);
    counts_.read_bytes += double(count);
    if (reader_->feed(ByteView(bytes).first(std::size_t(count))) == MessageReader::Damage::none) return;
    ++counts_.damaged;
    close(now_s);
  }

  void close(double now_s) {
    counts_.closed += connected_;
    socket_ = Socket();
    connected_ = false;
    to_send_.clear();
    again_s_ = now_s + kPause_s;
  }

  Habit habit_;
  std::mt19937 random_;
  Counts& counts_;
  Socket socket_;
  bool connected_ = false;
  double again_s_ = 0;
  Bytes to_send_;
  std::unique_ptr<MessageReader> reader_;
};

int flood(std::uint16_t port, std::size_t clients, double seconds, std::uint32_t seed) {
  const Address server = numeric_address("127.0.0.1", port);
  const double begin_s = steady_now_s();
  Counts counts;
  counts.connected_s = begin_s;
  std::vector<Client> all;
  for (std::size_t i = 0; i < clients; ++i) all.emplace_back(Habit(i % kHabits), seed + std::uint32_t(i), counts);
  std::vector<pollfd> waiting;
  for (double now_s = begin_s; now_s < begin_s + seconds; now_s = steady_now_s()) {
    waiting.clear();
    for (Client& client : all) {
      client.connect(server, now_s);
      waiting.push_back({client.socket().get(), client.waits_for(), 0});
    }
    ::poll(waiting.data(), waiting.size(), 50);
    for (std::size_t i = 0; i < all.size(); ++i) all[i].turn(waiting[i].revents, steady_now_s());
  }
  std::printf(
      "%zu clients, %.0f s: %ld connections, %ld closed by the server; %ld messages besides pictures, "
      "%ld damaged; %.1f MB read, %.1f MB sent\n",
      clients, seconds, counts.connections, counts.closed, counts.messages, counts.damaged, counts.read_bytes / 1e6,
      counts.sent_bytes / 1e6);
  // Sockets that are connected keep their places, so that nobody may have been able to connect for long.
  const bool some_connected = counts.closed < counts.connections;
  const bool answered = some_connected || steady_now_s() - counts.connected_s < kSilent_s;
  return counts.connections > 0 && answered && counts.damaged == 0 ? 0 : 1;
}

}  // namespace
}  // namespace insonate::igtl

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "flood PORT CLIENTS SECONDS SEED\n");
    return 2;
  }
  return insonate::igtl::flood(std::uint16_t(std::atoi(argv[1])), std::size_t(std::atoi(argv[2])), std::atof(argv[3]),
                               std::uint32_t(std::atol(argv[4])));
}
