#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/igtl/host_lookup.h"
#include "devices/igtl/igtl_reader.h"
#include "devices/igtl/image_queue.h"
#include "devices/igtl/net_socket.h"
#include "devices/igtl/sender_clock.h"
#include "devices/live/raw_source.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate::igtl {

/// Where a client connects, and which transform it takes.
struct ClientRequest {
  std::string host;
  std::uint16_t port = kDefaultPort;
  std::string name;  ///< name of the transform; empty: the first that arrives
  /// Whether transforms lead to RAS instead of LPS; if it is not said, those whose name ends with "ToRas" do.
  std::optional<bool> ras;
  bool sender_times = false;  ///< steps between samples follow the senders' time stamps
  SenderClock clock;          ///< converts the sender's times to ours
  /// Where IMAGE messages go: those of the first name that arrives. Null: they are skipped. With images, a stream
  /// without a transform is not a problem.
  std::shared_ptr<ImageQueue> images;
};

/// Receives poses from an OpenIGTLink server: its TRANSFORM messages, and on request its IMAGE messages. read() never
/// waits longer than its timeout. MessageReader bounds the memory used, whatever the server sends: to
/// MessageReader::kMaxKept, or with images to kMaxKeptWithImages. A larger image is a problem that ImageQueue states.
///
/// Samples are stamped when their bytes arrive, or with `sender_times` by the stamps of their messages (SenderClock).
class ClientSource : public RawSource {
public:
  static constexpr double kConnect_s = 3.0;      ///< a host that has not answered by then is tried again later
  static constexpr double kNameMissing_s = 2.0;  ///< users are informed if the named transform is missing for this long
  static constexpr double kStatusShown_s =
      5.0;  ///< so long are a STATUS error, unless revoked, and damaged messages shown

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
  void take_image(const Header& header, ByteView content);
  bool leads_to_ras() const;
  double time_of(const Header& header, double arrival_s);
  std::string note(double now_s) const;
  [[noreturn]] void give_up(const std::string& problem);

  ClientRequest request_;
  std::string where_;  ///< "host:port"
  std::optional<HostLookup> lookup_;
  std::vector<Address> untried_;
  Socket socket_;
  bool connected_ = false;
  double since_s_ = 0;  ///< start of the current phase: lookup, connecting, connection; then time of the newest sample
  std::unique_ptr<MessageReader> reader_;
  LiveBatch* batch_ = nullptr;  ///< where the message being read goes
  double arrival_s_ = 0;

  std::string followed_;             ///< name of the transform that is used
  std::string image_;                ///< name of the images that are used
  std::vector<std::string> others_;  ///< up to six names of other transforms that arrived
  std::string status_;               ///< error text of the server's last STATUS
  double status_s_ = 0;              ///< when the last STATUS arrived
  std::uint64_t damaged_ = 0;        ///< number of messages with a wrong CRC
  double damaged_s_ = 0;             ///< when the last of them arrived
  std::string failure_;              ///< why the last connection failed; cleared when a sample arrives
  SenderClock clock_;
};

/// Makes igtl://host[:port][/name][?frame=ras&time=sender]. Does not connect yet. Throws InputError.
std::unique_ptr<RawSource> make_igtl(const TrackerUri& uri, const TrackerContext& context);

/// Parses the URI. Throws InputError.
ClientRequest client_request(const TrackerUri& uri);

}  // namespace insonate::igtl
