#pragma once

#include <string>

#include "app/pictures/picture_reader.h"
#include "app/session/session.h"
#include "devices/igtl/igtl_server.h"
#include "sim/core/image.h"

namespace insonate {

/// Where --igtl-server listens: "[ADDRESS:]PORT", loopback unless an address is given, IPv6 in brackets. Throws
/// InputError.
igtl::Address parse_server_address(const std::string& text);

/// Tells OpenIGTLink clients what the session does, in RAS as 3D Slicer has it:
///   TRANSFORM "ProbeToRas"  where the picture is taken, each frame; none while no usable pose comes
///   IMAGE "Ultrasound"      the picture, when there is another; at most kMostPixels, coarser if need be
///   STATUS "Insonate"       what is going on, when that has changed
///   STRING "Event"          "exam started: ...", "step 2 of 3: ...", "exam finished: 84 %, passed", "frozen", "live",
///                           "mark 1", "tracking lost", "tracking"
/// While nobody is connected it wants no picture, so that none has to be read back from the graphics card.
class IgtlFeed {
public:
  static constexpr int kMostPixels = 1 << 20;

  explicit IgtlFeed(const igtl::Address& address) : server_(address, "--igtl-server") {}

  /// Events, status and pose; to be called once a frame.
  void tell(const Session& session);
  /// Whether somebody is there to see a picture.
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

/// With every `stride`-th pixel, the smallest stride that leaves at most `most` pixels; how it lies is told anew.
DrawnPicture thinned(const DrawnPicture& picture, int most);

/// Where the middle of a picture lies and how it is turned, in RAS.
Pose ras_from_picture(const DrawnPicture& picture);

}  // namespace insonate
