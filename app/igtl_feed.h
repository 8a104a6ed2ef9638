#pragma once

#include <functional>
#include <optional>
#include <string>

#include "app/session.h"
#include "devices/igtl/igtl_server.h"
#include "sim/core/image.h"

namespace insonate {

/// Where --igtl-server listens: "[ADDRESS:]PORT", loopback unless an address is given, IPv6 in brackets. Throws
/// InputError.
igtl::Address parse_server_address(const std::string& text);

/// A picture of the session and how it lies in the probe's plane.
struct FeedPicture {
  Image<std::uint8_t> grey;
  ImageGeometry geometry;
};

/// Tells OpenIGTLink clients what the session does, in RAS as 3D Slicer has it:
///   TRANSFORM "ProbeToRas"  where the picture is taken, each frame; none while no usable pose comes
///   IMAGE "Ultrasound"      the picture, when it has changed; at most kMostPixels, coarser if need be
///   STATUS "Insonate"       what is going on, when that has changed
///   STRING "Event"          "exam started: ...", "step 2 of 3: ...", "exam finished: 84 %, passed", "frozen", "live",
///                           "tracking lost", "tracking"
/// While nobody is connected no picture is asked for, so that none has to be read back from the graphics card.
class IgtlFeed {
public:
  static constexpr int kMostPixels = 1 << 20;

  explicit IgtlFeed(const igtl::Address& address) : server_(address, "--igtl-server") {}

  /// To be called once a frame, after the pictures are drawn. `picture_version` changes whenever the picture does, and
  /// `read_picture` is asked for it only then; it returns nothing when there is none yet.
  void tell(const Session& session, long picture_version,
            const std::function<std::optional<FeedPicture>()>& read_picture);

  const igtl::Server& server() const { return server_; }

private:
  void tell_events(const Session& session, std::uint64_t stamp);
  void announce(const std::string& text, std::uint64_t stamp);

  igtl::Server server_;
  long sent_version_ = -1;
  std::string sent_status_;
  int attempt_ = 0;
  bool exam_ = false, finished_ = false, frozen_ = false, lost_ = false;
  std::size_t step_ = 0;
};

/// With every `stride`-th pixel, the smallest stride that leaves at most `most` pixels; how it lies is told anew.
FeedPicture thinned(const FeedPicture& picture, int most);

/// Where the middle of a picture lies and how it is turned, in RAS, for a probe at `patient_from_probe` (LPS).
Pose ras_from_picture(const Pose& patient_from_probe, const FeedPicture& picture);

}  // namespace insonate
