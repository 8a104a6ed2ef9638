#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/igtl/host_lookup.h"
#include "devices/igtl/igtl_reader.h"
#include "devices/igtl/net_socket.h"
#include "devices/igtl/sender_clock.h"
#include "devices/live/raw_source.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate::igtl {

/// Where a client connects to and what it takes from there.
struct ClientRequest {
  std::string host;
  std::uint16_t port = kDefaultPort;
  std::string name;           ///< of the transform; empty: the first that comes
  bool ras = false;           ///< transforms lead to RAS instead of LPS
  bool sender_times = false;  ///< steps between samples are those of the messages' own times
  SenderClock clock;          ///< that takes them to ours
};

/// Poses from an OpenIGTLink server: its TRANSFORM messages. Reading never waits longer than asked, and what the server
/// sends is bounded by MessageReader, whatever it is.
///
/// Samples are stamped when their bytes arrive, or with `sender_times` by their messages' own stamps (SenderClock).
class ClientSource : public RawSource {
public:
  static constexpr double kConnect_s = 3.0;      ///< a host that has not answered by then is asked again later
  static constexpr double kNameMissing_s = 2.0;  ///< after so long without the transform that was named, say so
  static constexpr double kStatusTold_s = 5.0;   ///< for so long a STATUS is told that nothing has revoked

  explicit ClientSource(ClientRequest request);

  std::string name() const override { return "OpenIGTLink from " + where_; }
  void open() override;
  void read(std::chrono::milliseconds timeout, LiveBatch& batch) override;
  void close() noexcept override;
  bool replay_open(const AttachedDevice& device, double time_s) override;
  void replay_read(insonate::Bytes bytes, double time_s, LiveBatch& batch) override;

private:
  void begin(double time_s);
  void connect_next();
  bool connected(std::chrono::milliseconds timeout);
  void receive(LiveBatch& batch);
  bool wants(const Header& header);
  void take(const Header& header, ByteView body, LiveBatch& batch);
  double time_of(const Header& header, double arrival_s);
  std::string note(double now_s) const;
  [[noreturn]] void give_up(const std::string& problem);

  ClientRequest request_;
  std::string where_;  ///< "host:port"
  std::optional<HostLookup> lookup_;
  std::vector<Address> untried_;
  Socket socket_;
  bool connected_ = false;
  double since_s_ = 0;  ///< of the lookup, then of the try to connect, then of the connection or the newest sample
  std::unique_ptr<MessageReader> reader_;
  LiveBatch* batch_ = nullptr;  ///< where the message goes that is being read
  double arrival_s_ = 0;

  std::string followed_;             ///< the transform that is taken
  std::vector<std::string> others_;  ///< names that came but are not taken, some of them
  std::string status_;               ///< what the server's last STATUS complained of
  double status_s_ = 0;              ///< when that came
  std::uint64_t damaged_ = 0;        ///< messages whose CRC was wrong
  std::string failure_;              ///< why the last connection failed, until a sample comes
  SenderClock clock_;
};

/// igtl://host[:port][/name][?frame=ras&time=sender]. Opens nothing yet. Throws InputError.
std::unique_ptr<RawSource> make_igtl(const TrackerUri& uri, const TrackerContext& context);

/// Takes the URI apart. Throws InputError.
ClientRequest client_request(const TrackerUri& uri);

}  // namespace insonate::igtl
