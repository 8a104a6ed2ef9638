#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "devices/igtl/igtl_message.h"

namespace insonate::igtl {

/// Passes images from the thread that receives them to the one that uses them. If that one is late, the oldest images
/// are dropped. Both threads hold the lock only to move an image.
class ImageQueue {
public:
  static constexpr std::size_t kMax = 16;

  void put(ReceivedImage image) {
    const std::lock_guard lock(mutex_);
    ++received_;
    if (images_.size() == kMax) images_.pop_front();
    images_.push_back(std::move(image));
    problem_.clear();
  }
  /// States why the newest image cannot be used, as a part of a sentence.
  void complain(std::string problem) {
    const std::lock_guard lock(mutex_);
    problem_ = std::move(problem);
  }
  /// Appends the images that have arrived since the last call, the oldest first.
  void take(std::vector<ReceivedImage>& images) {
    const std::lock_guard lock(mutex_);
    for (ReceivedImage& image : images_) images.push_back(std::move(image));
    images_.clear();
  }
  /// Returns how many images have arrived, including those that were dropped.
  std::uint64_t received() const {
    const std::lock_guard lock(mutex_);
    return received_;
  }
  /// Returns why the newest image could not be used; empty if it could.
  std::string problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
  }

private:
  mutable std::mutex mutex_;
  std::deque<ReceivedImage> images_;
  std::uint64_t received_ = 0;
  std::string problem_;
};

}  // namespace insonate::igtl
