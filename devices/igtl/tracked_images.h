#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "devices/igtl/igtl_message.h"
#include "devices/igtl/image_queue.h"
#include "devices/live/live_tracker.h"
#include "devices/pose_history.h"
#include "sim/core/image.h"
#include "sim/core/pose.h"

namespace insonate::igtl {

/// An image with the place of its probe at its time.
struct TrackedImage {
  Image<std::uint8_t> grey;
  Pose sweep_from_probe;             ///< in the frame of the transforms
  glm::dmat4 frame_from_pixel{1.0};  ///< as the IMAGE message states it
  double time_s = 0;
};

/// How the images of a stream lie in space.
enum class ImagePlace {
  by_transform,  ///< the TRANSFORM of the image's time places the probe
  by_image,      ///< the IMAGE message places the image; the probe's pose is the identity
};

/// Receives ultrasound from an OpenIGTLink server and pairs each image with the pose of its time. A thread of its own
/// receives. Times are those of the messages' stamps, or of their arrival where the sender gives none.
///
///     TrackedImages stream("igtl://localhost:18944/ProbeToTracker", ImagePlace::by_transform);
///     stream.poll(steady_now_s(), images);  // each frame
class TrackedImages {
public:
  /// An image that waits longer for the next pose is dropped, s. A pose is not bridged over more than
  /// PoseHistory::kBridge_s either.
  static constexpr double kMaxWait_s = 0.5;
  /// A stream without images or without poses is a problem after this long, s.
  static constexpr double kMissing_s = 3;

  /// Does not connect yet. Throws InputError if the URI is not that of an OpenIGTLink server.
  TrackedImages(const std::string& uri, ImagePlace place);
  ~TrackedImages();

  /// Appends the images that can be placed, the oldest first. The first call connects.
  /// @param now_s  of steady_now_s()
  void poll(double now_s, std::vector<TrackedImage>& images);

  std::uint64_t received() const { return queue_->received(); }
  std::uint64_t unplaced() const { return unplaced_; }

  /// Returns what is wrong with the stream now and what to do, as a sentence; empty if nothing is.
  std::string problem() const;
  /// Returns whether anything has arrived from the server.
  bool is_connected() const { return received() > 0 || tracker_.state().delivered > 0; }

private:
  bool place(ReceivedImage& image, TrackedImage& placed) const;

  std::string uri_, where_;
  ImagePlace place_;
  std::shared_ptr<ImageQueue> queue_;
  LiveTracker tracker_;
  PoseHistory history_;
  std::deque<ReceivedImage> waiting_;
  double newest_pose_s_ = -1e300, now_s_ = 0, first_s_ = -1, last_image_s_ = 0, last_placed_s_ = 0, last_pose_s_ = 0;
  std::uint64_t unplaced_ = 0;
};

}  // namespace insonate::igtl
