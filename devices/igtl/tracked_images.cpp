#include "devices/igtl/tracked_images.h"

#include <utility>

#include "devices/igtl/igtl_source.h"
#include "devices/tracker_uri.h"
#include "sim/core/input_error.h"
#include "sim/core/probe_sample.h"

namespace insonate::igtl {
namespace {

constexpr std::size_t kMaxWaiting = 32;  // images

ClientRequest request_of(const std::string& text, const std::shared_ptr<ImageQueue>& queue) {
  const TrackerUri uri = parse_tracker_uri(text);
  if (uri.scheme != "igtl")
    throw InputError("tracker '" + text + "'", "", "only an OpenIGTLink server sends images with the poses",
                     "write it as in 'igtl://localhost:18944/ProbeToTracker'");
  ClientRequest request = client_request(uri);
  request.images = queue;
  request.sender_times = uri.options.find("time") == uri.options.end() || request.sender_times;
  return request;
}

}  // namespace

TrackedImages::TrackedImages(const std::string& uri, ImagePlace place)
    : uri_(uri),
      place_(place),
      queue_(std::make_shared<ImageQueue>()),
      tracker_(std::make_unique<ClientSource>(request_of(uri, queue_))) {
  const std::size_t host = uri.find("//");
  where_ = host == std::string::npos ? uri : uri.substr(host + 2, uri.find('/', host + 2) - host - 2);
}

TrackedImages::~TrackedImages() = default;

bool TrackedImages::place(ReceivedImage& image, TrackedImage& placed) const {
  placed.frame_from_pixel = image.frame_from_pixel;
  placed.time_s = image.time_s;
  if (place_ == ImagePlace::by_transform) {
    const PoseEstimate at = history_.at(image.time_s, 0);
    if (at.how != PoseAnswer::exact && at.how != PoseAnswer::interpolated) return false;
    placed.sweep_from_probe = at.patient_from_probe;
  }
  placed.grey = std::move(image.grey);
  return true;
}

void TrackedImages::poll(double now_s, std::vector<TrackedImage>& images) {
  if (first_s_ < 0) first_s_ = last_image_s_ = last_placed_s_ = last_pose_s_ = now_s;
  now_s_ = now_s;
  std::vector<ProbeSample> samples;
  tracker_.poll(now_s, samples);
  for (const ProbeSample& sample : samples) {
    history_.add(sample);
    newest_pose_s_ = sample.time_s;
    if (sample.status == PoseStatus::ok) last_pose_s_ = now_s;
  }
  std::vector<ReceivedImage> arrived;
  queue_->take(arrived);
  for (ReceivedImage& image : arrived) {
    last_image_s_ = now_s;
    waiting_.push_back(std::move(image));
  }
  while (!waiting_.empty()) {
    ReceivedImage& image = waiting_.front();
    // The pose behind an image may arrive after it.
    const bool due = place_ == ImagePlace::by_image || newest_pose_s_ >= image.time_s ||
                     now_s - image.time_s > kMaxWait_s || waiting_.size() > kMaxWaiting;
    if (!due) break;
    TrackedImage placed;
    if (place(image, placed)) {
      last_placed_s_ = now_s;
      images.push_back(std::move(placed));
    } else {
      ++unplaced_;
    }
    waiting_.pop_front();
  }
}

std::string TrackedImages::problem() const {
  const std::string stated = queue_->problem();
  if (!stated.empty()) return stated + ".";
  if (const std::string of_tracker = tracker_.state().problem; !of_tracker.empty()) return of_tracker;
  if (now_s_ - last_image_s_ > kMissing_s)
    return where_ + " sends no IMAGE: add the ultrasound to what the server sends.";
  if (place_ == ImagePlace::by_image || now_s_ - last_placed_s_ <= kMissing_s) return "";
  if (now_s_ - last_pose_s_ > kMissing_s)
    return where_ + " sends images, but no usable TRANSFORM: add that of the probe, or see whether it is tracked.";
  return where_ +
         " sends images and transforms whose times do not fit: let one clock stamp both, with a transform every 0.1 s "
         "or "
         "more often.";
}

}  // namespace insonate::igtl
