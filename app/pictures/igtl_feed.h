#pragma once

#include <string>

#include "app/pictures/picture_reader.h"
#include "app/session/session.h"
#include "devices/igtl/igtl_server.h"
#include "sim/core/image.h"

namespace insonate {

/// Parses a server's address: "[ADDRESS:]PORT". The default is loopback; an IPv6 address is written in brackets. Throws
/// InputError.
/// @param file, place  where the text comes from
igtl::Address parse_server_address(const std::string& text, const std::string& file = "command line",
                                   const std::string& place = "--igtl-server");

/// Publishes the session to OpenIGTLink clients, in RAS as 3D Slicer uses it:
///   TRANSFORM "ProbeToRas"  the pose of the picture, each frame; none while no usable pose comes
///   IMAGE "Ultrasound"      each new picture; at most kMaxPixels, subsampled if it has more
///   STATUS "Insonate"       the state of the session, when it has changed
///   STRING "Event"          "exam started: ...", "step 2 of 3: ...", "exam finished: 84 %, passed", "frozen", "live",
///                           "mark 1", "tracking lost", "tracking"
/// While no client is connected it asks for no picture, so that none is read back from the graphics card.
class IgtlFeed {
public:
  static constexpr int kMaxPixels = 1 << 20;

  explicit IgtlFeed(const igtl::Address& address) : server_(address, "--igtl-server") {}

  /// Publishes events, status and pose; to be called once per frame.
  void publish(const Session& session);
  /// Returns whether a client is connected.
  bool wants_pictures() const { return server_.clients() > 0; }
  void show(const DrawnPicture& picture);

  const igtl::Server& server() const { return server_; }

private:
  void tell_events(const Session& session, std::uint64_t stamp);
  void announce(const std::string& text, std::uint64_t stamp);

  igtl::Server server_;
  std::string sent_status_;
  int attempt_ = 0;
  bool exam_ = false, finished_ = false, frozen_ = false, lost_ = false;
  std::size_t step_ = 0, sent_markers_ = 0;
};

/// Returns the picture with every `stride`-th pixel and the geometry adapted. The stride is the smallest that leaves at
/// most `most` pixels.
DrawnPicture thinned(const DrawnPicture& picture, int most);

/// Returns the pose of the picture's centre and axes in RAS.
Pose ras_from_picture(const DrawnPicture& picture);

}  // namespace insonate
