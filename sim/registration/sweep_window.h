#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "sim/registration/tracked_sweep.h"

namespace insonate {

/// Keeps the newest images of a probe that moves, and chooses those that are worth registering: well spread, the newest
/// first. A probe that rests adds nothing.
class SweepWindow {
public:
  static constexpr std::size_t kKept = 120;  ///< images, some 6 MB at 128 x 96 pixels
  static constexpr double kMinApart_mm = 1;  ///< root mean square distance of an image's fan from the last one's

  /// @param probe, depth_mm  of all images
  SweepWindow(const Probe& probe, double depth_mm);

  /// Adds an image. One that lies where the last one does replaces it.
  void add(SweepImage image);
  void clear();

  std::size_t size() const { return kept_.size(); }
  /// Returns a number that changes when an image is added.
  std::uint64_t version() const { return version_; }

  /// Returns up to `count` images: the newest, and then always the one that lies farthest from those chosen. Equal
  /// windows give equal choices.
  TrackedSweep chosen(std::size_t count) const;

private:
  double apart_mm(const Pose& a, const Pose& b) const;

  Probe probe_;
  double depth_mm_;
  glm::dmat4 fan_moments_{0.0};  // of a fan's points, in the probe's frame
  std::deque<SweepImage> kept_;  // the oldest first
  std::uint64_t version_ = 0;
};

}  // namespace insonate
