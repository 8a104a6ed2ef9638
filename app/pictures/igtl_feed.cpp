#include "app/pictures/igtl_feed.h"

#include <charconv>
#include <chrono>
#include <cstdio>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

using Stream = igtl::Server::Stream;

// Codes of the protocol's STATUS message.
constexpr std::uint16_t kLost = 7;

/// LPS and RAS differ by a rotation of 180 degrees about the patient's long axis.
Pose ras_from(const Pose& lps) {
  const Pose half_turn{glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1), glm::dvec3(0)};
  return half_turn * lps;
}

std::uint64_t stamp_now() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return igtl::stamp_of(std::chrono::duration<double>(since_1970).count());
}

std::string step_text(const Runner& runner) {
  const auto& steps = runner.scenario().steps;
  const std::size_t step = runner.live().step;
  return "step " + std::to_string(step + 1) + " of " + std::to_string(steps.size()) + ": " + steps[step].title;
}

std::string result_text(const ExamResult& result) {
  char percent[32];
  std::snprintf(percent, sizeof percent, "%.1f %%", result.percent);
  return std::string(percent) + (result.passed ? ", passed" : ", not passed");
}

std::string status_text(const Session& session) {
  if (session.result()) return "exam finished: " + result_text(*session.result());
  if (session.runner()) return "exam, " + step_text(*session.runner());
  return "practice";
}

}  // namespace

igtl::Address parse_server_address(const std::string& text, const std::string& file, const std::string& place) {
  const auto refuse = [&](const std::string& problem) {
    throw InputError(file, place, "'" + text + "' " + problem,
                     "write a port as in '18944', or an address of this computer before it as in '0.0.0.0:18944'");
  };
  const std::size_t colon = text.rfind(':');
  std::string host = colon == std::string::npos ? "127.0.0.1" : text.substr(0, colon);
  const std::string port_text = colon == std::string::npos ? text : text.substr(colon + 1);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  std::uint16_t port = 0;
  const char* const end = port_text.data() + port_text.size();
  const auto read = std::from_chars(port_text.data(), end, port);
  if (read.ec != std::errc() || read.ptr != end || port == 0) refuse("has no port from 1 to 65535 at its end");
  const igtl::Address address = igtl::numeric_address(host, port);
  if (address.size == 0) refuse("has no address in numbers before its port");
  return address;
}

DrawnPicture thinned(const DrawnPicture& picture, int most) {
  const Image<std::uint8_t>& from = picture.grey;
  int stride = 1;
  const auto left = [&](int pixels) { return (pixels + stride - 1) / stride; };
  while (left(from.width) * left(from.height) > most) ++stride;
  if (stride == 1) return picture;
  DrawnPicture out = picture;
  out.grey = Image<std::uint8_t>(left(from.width), left(from.height));
  for (int y = 0; y < out.grey.height; ++y)
    for (int x = 0; x < out.grey.width; ++x) out.grey.at(x, y) = from.at(x * stride, y * stride);
  out.geometry.width = out.grey.width;
  out.geometry.height = out.grey.height;
  out.geometry.mm_per_pixel *= stride;
  return out;
}

Pose ras_from_picture(const DrawnPicture& picture) {
  const glm::dvec2 middle = picture.geometry.plane_mm((picture.grey.width - 1) / 2.0, (picture.grey.height - 1) / 2.0);
  return ras_from(picture.patient_from_probe * Pose{glm::dmat3(1.0), glm::dvec3(middle, 0.0)});
}

void IgtlFeed::announce(const std::string& text, std::uint64_t stamp) {
  server_.announce(igtl::make_string("Event", stamp, text));
}

void IgtlFeed::tell_events(const Session& session, std::uint64_t stamp) {
  const Runner* runner = session.runner();
  const bool begins = session.attempt() != attempt_ || exam_ != (runner != nullptr);
  attempt_ = session.attempt();
  exam_ = runner != nullptr;
  if (begins) {
    finished_ = false;
    step_ = sent_markers_ = 0;
    announce(runner ? "exam started: " + runner->scenario().title : "practice started", stamp);
  }
  if (runner && (begins || runner->live().step != step_)) {
    step_ = runner->live().step;
    announce(step_text(*runner), stamp);
  }
  if (session.result() && !finished_) {
    finished_ = true;
    announce("exam finished: " + result_text(*session.result()), stamp);
  }
  if (session.machine().frozen != frozen_) {
    frozen_ = !frozen_;
    announce(frozen_ ? "frozen" : "live", stamp);
  }
  while (sent_markers_ < session.event_markers_s().size()) announce("mark " + std::to_string(++sent_markers_), stamp);
  if (session.lost_for_s().has_value() != lost_) {
    lost_ = !lost_;
    announce(lost_ ? "tracking lost" : "tracking", stamp);
  }
}

void IgtlFeed::publish(const Session& session) {
  const std::uint64_t stamp = stamp_now();
  tell_events(session, stamp);
  const std::string status = lost_ ? "no usable pose" : status_text(session);
  if (status != sent_status_) {
    sent_status_ = status;
    server_.publish(Stream::status, igtl::make_status("Insonate", stamp, {lost_ ? kLost : igtl::kStatusOk, status}));
  }
  // A client that connects later must not receive an outdated picture or pose.
  const bool seen = wants_pictures() && session.shown_pose();
  if (!seen) server_.forget(Stream::image);
  if (!seen || lost_)
    server_.forget(Stream::pose);
  else
    server_.publish(Stream::pose, igtl::make_transform("ProbeToRas", stamp, ras_from(*session.shown_pose())));
}

void IgtlFeed::show(const DrawnPicture& picture) {
  if (!wants_pictures()) return;
  const DrawnPicture small = thinned(picture, kMaxPixels);
  server_.publish(Stream::image, igtl::make_image("Ultrasound", stamp_now(), small.grey, ras_from_picture(small),
                                                  small.geometry.mm_per_pixel));
}

}  // namespace insonate
