#include "sim/registration/sweep_window.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace insonate {

SweepWindow::SweepWindow(const Probe& probe, double depth_mm) : probe_(probe), depth_mm_(depth_mm) {
  fan_moments_ = moments_of(target_points({Probe(probe), depth_mm, std::vector<SweepImage>(1)}));
}

double SweepWindow::apart_mm(const Pose& a, const Pose& b) const {
  return target_error_mm(fan_moments_, a.matrix(), b.matrix());
}

void SweepWindow::add(SweepImage image) {
  ++version_;
  if (!kept_.empty() && apart_mm(kept_.back().sweep_from_probe, image.sweep_from_probe) < kMinApart_mm)
    kept_.pop_back();
  if (kept_.size() == kKept) kept_.pop_front();
  kept_.push_back(std::move(image));
}

void SweepWindow::clear() {
  kept_.clear();
  ++version_;
}

TrackedSweep SweepWindow::chosen(std::size_t count) const {
  TrackedSweep sweep{Probe(probe_), depth_mm_, {}};
  std::vector<double> apart(kept_.size(), std::numeric_limits<double>::infinity());
  std::size_t next = kept_.size() - 1;
  while (sweep.images.size() < std::min(count, kept_.size())) {
    sweep.images.push_back(kept_[next]);
    for (std::size_t i = 0; i < kept_.size(); ++i)
      apart[i] = std::min(apart[i], apart_mm(kept_[i].sweep_from_probe, kept_[next].sweep_from_probe));
    apart[next] = -1;
    // Of images that are equally far, the newest.
    next = kept_.size() - 1 - std::size_t(std::max_element(apart.rbegin(), apart.rend()) - apart.rbegin());
  }
  return sweep;
}

}  // namespace insonate
