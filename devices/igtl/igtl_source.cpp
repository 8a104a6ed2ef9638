#include "devices/igtl/igtl_source.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>

#include "devices/live/steady_clock.h"
#include "devices/sequence/sequence.h"
#include "sim/core/input_error.h"

namespace insonate::igtl {
namespace {

constexpr std::size_t kMaxNames = 6;

/// Returns whether an event happened on the socket within `timeout`.
bool wait_for(const Socket& socket, short events, std::chrono::milliseconds timeout) {
  pollfd waiting{socket.get(), events, 0};
  return ::poll(&waiting, 1, int(timeout.count())) > 0;
}

/// Converts from a patient's frame in RAS to LPS: 180 degrees about the long axis.
Pose lps_from_ras(const Pose& ras_from_probe) {
  const Pose half_turn{glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1), glm::dvec3(0)};
  return half_turn * ras_from_probe;
}

}  // namespace

ClientSource::ClientSource(ClientRequest request) : request_(std::move(request)) {
  where_ = request_.host + ":" + std::to_string(request_.port);
}

void ClientSource::give_up(const std::string& problem) {
  failure_ = problem;
  throw SourceGone(problem);
}

void ClientSource::open() {
  lookup_.emplace(request_.host, request_.port);
  untried_.clear();
  connected_ = false;
  const double now_s = steady_now_s();
  if (tap()) tap()->opened({}, now_s);
  begin(now_s);
}

void ClientSource::begin(double time_s) {
  since_s_ = time_s;
  followed_ = request_.name;
  image_.clear();
  others_.clear();
  status_.clear();
  damaged_ = 0;
  clock_ = request_.clock;
  reader_ =
      std::make_unique<MessageReader>([this](const Header& header) { return wants(header); },
                                      [this](const Header& header, ByteView body) { take(header, body, *batch_); },
                                      request_.images ? MessageReader::kMaxKeptWithImages : MessageReader::kMaxKept);
}

bool ClientSource::replay_open(const AttachedDevice& device, double time_s) {
  if (device.vendor != 0 || device.product != 0) return false;
  begin(time_s);
  return true;
}

void ClientSource::close() noexcept {
  socket_ = Socket();
  lookup_.reset();
  reader_.reset();
}

void ClientSource::connect_next() {
  const Address address = untried_.front();
  untried_.erase(untried_.begin());
  try {
    socket_ = begin_connect(address);
  } catch (const std::system_error& error) {
    if (untried_.empty()) give_up("No connection to " + where_ + ": " + error.code().message() + ".");
    return connect_next();
  }
  since_s_ = steady_now_s();
}

bool ClientSource::connected(std::chrono::milliseconds timeout) {
  if (lookup_) {
    const auto addresses = lookup_->answer();
    if (!addresses) {
      std::this_thread::sleep_for(timeout);
      return false;
    }
    lookup_.reset();
    if (addresses->empty())
      give_up("There is no host '" + request_.host + "' on this network: check its name and the network.");
    untried_ = *addresses;
    connect_next();
  }
  if (!wait_for(socket_, POLLOUT, timeout)) {
    if (steady_now_s() - since_s_ < kConnect_s) return false;
    if (untried_.empty())
      give_up(where_ + " does not answer: is the computer on, and does its firewall let port " +
              std::to_string(request_.port) + " through?");
    connect_next();
    return false;
  }
  if (const int error = connect_error(socket_); error != 0) {
    if (!untried_.empty()) {
      connect_next();
      return false;
    }
    give_up("No connection to " + where_ + ": " + std::generic_category().message(error) +
            (error == ECONNREFUSED ? "; is the OpenIGTLink server started there?" : "."));
  }
  since_s_ = steady_now_s();
  return connected_ = true;
}

void ClientSource::read(std::chrono::milliseconds timeout, LiveBatch& batch) {
  if (!connected_ && !connected(timeout)) {
    batch.note = failure_.empty() ? "Connecting to " + where_ + "." : failure_;
    return;
  }
  if (wait_for(socket_, POLLIN, timeout)) receive(batch);
  const double now_s = steady_now_s();
  if (!batch.samples.empty()) {
    since_s_ = now_s;
    failure_.clear();
  }
  batch.note = note(now_s);
}

void ClientSource::receive(LiveBatch& batch) {
  // Reads a few pieces and then returns, so that a server that sends without end does not block the thread.
  std::array<std::uint8_t, 16384> bytes;
  for (int piece = 0; piece < 16; ++piece) {
    const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
    const double arrival_s = steady_now_s();
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (count < 0) give_up("The connection to " + where_ + " broke: " + std::generic_category().message(errno) + ".");
    if (count == 0) give_up(where_ + " has closed the connection.");
    const ByteView came(bytes.data(), std::size_t(count));
    if (tap()) tap()->came(came, arrival_s);
    replay_read(came, arrival_s, batch);
  }
}

void ClientSource::replay_read(insonate::Bytes bytes, double time_s, LiveBatch& batch) {
  batch_ = &batch;
  arrival_s_ = time_s;
  switch (reader_->feed(bytes)) {
    case MessageReader::Damage::none:
      break;
    case MessageReader::Damage::crc:
      ++damaged_;
      damaged_s_ = arrival_s_;
      break;
    case MessageReader::Damage::not_igtl:
      give_up("What " + where_ + " sends is not OpenIGTLink: check the port.");
  }
  batch.note = note(time_s);
}

bool ClientSource::wants(const Header& header) {
  if (header.type == "STATUS") return true;
  if (header.type == "IMAGE" && request_.images) {
    if (image_.empty()) image_ = header.name;
    if (header.name != image_) return false;
    if (header.body_bytes > MessageReader::kMaxKeptWithImages)
      request_.images->complain("an image of " + where_ + " has more than 16 MiB");
    return true;
  }
  if (header.type != "TRANSFORM") return false;
  if (followed_.empty()) followed_ = header.name;
  if (header.name == followed_) return true;
  const bool known = std::find(others_.begin(), others_.end(), header.name) != others_.end();
  if (!known && others_.size() < kMaxNames) others_.push_back(header.name);
  return false;
}

void ClientSource::take(const Header& header, ByteView body, LiveBatch& batch) {
  const auto parts = parts_of(header, body);
  if (!parts) return;
  if (header.type == "STATUS") {
    const auto status = parse_status(parts->content);
    if (status) status_ = status->code == kStatusOk ? "" : status->text;
    status_s_ = arrival_s_;
    return;
  }
  if (header.type == "IMAGE") return take_image(header, parts->content);
  const auto matrix = parse_transform(parts->content);
  const std::string status = metadata_value(*parts, "TransformStatus");
  ProbeSample sample;
  sample.time_s = time_of(header, arrival_s_);
  sample.status = status.empty() ? PoseStatus::ok : status_from_igsio(status);
  if (!matrix || (sample.status == PoseStatus::ok && why_not_rigid(*matrix))) sample.status = PoseStatus::invalid;
  if (sample.status == PoseStatus::ok) {
    sample.patient_from_probe = pose_from_matrix(*matrix);
    if (leads_to_ras()) sample.patient_from_probe = lps_from_ras(sample.patient_from_probe);
  }
  batch.samples.push_back(sample);
}

void ClientSource::take_image(const Header& header, ByteView content) {
  auto parsed = parse_image(content);
  if (const auto* problem = std::get_if<std::string>(&parsed))
    return request_.images->complain("an image of " + where_ + " " + *problem);
  auto& image = std::get<ReceivedImage>(parsed);
  image.time_s = time_of(header, arrival_s_);
  if (leads_to_ras()) image.frame_from_pixel = lps_from_ras(Pose{}).matrix() * image.frame_from_pixel;
  request_.images->put(std::move(image));
}

bool ClientSource::leads_to_ras() const {
  std::string name = followed_;
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return request_.ras.value_or(name.ends_with("toras"));
}

double ClientSource::time_of(const Header& header, double arrival_s) {
  if (!request_.sender_times || header.stamp == 0) return arrival_s;
  return clock_.time_of(seconds_of(header.stamp), arrival_s);
}

std::string ClientSource::note(double now_s) const {
  if (!status_.empty() && now_s - status_s_ < kStatusShown_s) return where_ + " reports: " + status_;
  if (now_s - since_s_ > kNameMissing_s) {
    if (others_.empty() && request_.images) return "";
    if (others_.empty()) return where_ + " is connected but sends no transform.";
    std::string names;
    for (const std::string& name : others_) names += (names.empty() ? "'" : ", '") + name + "'";
    return where_ + " sends " + names + " but no transform '" + followed_ +
           "': name the one that is the probe's, as in igtl://" + where_ + "/" + others_.front() + ".";
  }
  if (damaged_ > 0 && now_s - damaged_s_ < kStatusShown_s)
    return std::to_string(damaged_) + " damaged messages from " + where_ + " were left out.";
  return "";
}

ClientRequest client_request(const TrackerUri& uri) {
  uri.allow_options({"frame", "time"});
  const auto refuse = [&](const std::string& problem) {
    throw InputError("tracker '" + uri.text + "'", "", problem,
                     "write it as in 'igtl://localhost:18944/ProbeToTracker'");
  };
  ClientRequest request;
  std::string_view rest = uri.subject;
  if (!rest.starts_with("//")) refuse("there is no '//' before the host");
  rest.remove_prefix(2);
  if (const std::size_t slash = rest.find('/'); slash != std::string_view::npos) {
    request.name = rest.substr(slash + 1);
    rest = rest.substr(0, slash);
    if (request.name.size() > 20) refuse("OpenIGTLink's names have 20 characters at most");
  }
  // An IPv6 address stands in brackets, because of its colons.
  const bool bracket = rest.starts_with('[');
  const std::size_t host_end = bracket ? rest.find(']') : std::min(rest.find(':'), rest.size());
  if (host_end == std::string_view::npos) refuse("the bracket of the host is not closed");
  request.host = rest.substr(bracket ? 1 : 0, host_end - (bracket ? 1 : 0));
  if (request.host.empty()) refuse("it names no host");
  if (request.host.size() > 253) refuse("a host's name has 253 characters at most");
  if (request.host.find_first_of(" \t") != std::string::npos) refuse("a host's name has no spaces");
  rest = rest.substr(host_end + (bracket ? 1 : 0));
  if (!rest.empty()) {
    const char *begin = rest.data() + 1, *end = rest.data() + rest.size();
    const auto read = std::from_chars(begin, end, request.port);
    if (rest.front() != ':' || read.ec != std::errc() || read.ptr != end || request.port == 0)
      refuse("'" + std::string(rest) + "' is not a port from 1 to 65535 after a colon");
  }
  const auto one_of = [&](const std::string& option, const std::string& usual, const std::string& other) {
    const auto found = uri.options.find(option);
    if (found == uri.options.end() || found->second == usual) return false;
    if (found->second != other)
      throw InputError("tracker '" + uri.text + "'", "option '" + option + "'",
                       "'" + found->second + "' is neither '" + usual + "' nor '" + other + "'", "change it");
    return true;
  };
  const bool ras = one_of("frame", "lps", "ras");
  if (uri.options.contains("frame")) request.ras = ras;
  request.sender_times = one_of("time", "arrival", "sender");
  return request;
}

std::unique_ptr<RawSource> make_igtl(const TrackerUri& uri, const TrackerContext&) {
  return std::make_unique<ClientSource>(client_request(uri));
}

}  // namespace insonate::igtl
