#include "app/pictures/quality_governor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace insonate {
namespace {

/// A frame is too slow above this share of its time. A screen of 60 Hz, which shows every second refresh, is not taken
/// for slow: its frames take their time to within a percent.
constexpr double kSlow = 1.04;
/// Above this share one turn per frame would not be enough.
constexpr double kMuchTooSlow = 1.4;
/// Below this share there is time for more.
constexpr double kQuick = 0.72;
/// The share that a decision aims at. Single frames take longer than the median, so the rate needs some time to spare.
constexpr double kAim = 0.85;
/// One view per two frames, before the ultrasound gets fewer pixels; fewer, once it has the fewest.
constexpr int kFewTurns = 2, kFewestTurns = 5;
/// With the fewest pixels the mean decides, because frames that draw the patient take longer than the median. Above the
/// first share there are fewer turns, below the second more: one more adds at most a sixth of the time of a view, which
/// fits between them up to 24 ms. A screen that waits for its refresh is not slow at a share of 1 (kSlow).
constexpr double kSlowInTheMean = 0.97, kQuickInTheMean = 0.85;
/// The mean is taken over this time, some fifteen frames.
constexpr double kMeanOver_s = 0.5;
/// Below this share there is time for all views in each frame: they take at most as long as the ultrasound.
constexpr double kQuickForAllViews = 0.45;
/// Most by which one decision changes the quality.
constexpr double kMinStep = 0.7, kMaxStep = 1.15;
/// The quality at which a software renderer's first motion begins; two cores end at 0.6 to 0.8.
constexpr double kOfSoftwareRenderer = 0.7;

}  // namespace

QualityGovernor::QualityGovernor(bool for_software_renderer)
    : waits_for_screen_(!for_software_renderer),
      of_motion_(for_software_renderer ? kOfSoftwareRenderer : 1),
      turns_of_motion_(for_software_renderer ? kFewTurns : 0) {}

void QualityGovernor::see(double now_s, double frame_s, bool computed) {
  const bool follows = std::exchange(computed_before_, computed) || now_s - computed_s_ < kRest_s;
  if (!computed) {
    moves_ = moves_ && follows;
    if (!moves_) at_floor_s_ = at_floor_ = 0;
    return;
  }
  if (moves_) see_motion(frame_s);
  // A single new picture is not motion: it follows a changed setting, or it is the full-resolution picture after a
  // motion.
  moves_ = follows;
  computed_s_ = now_s;
}

void QualityGovernor::see_motion(double frame_s) {
  if (of_motion_ <= kMin && turns_of_motion_ >= kFewTurns) {
    at_floor_s_ += frame_s;
    ++at_floor_;
    if (at_floor_ >= 3 && at_floor_s_ >= kMeanOver_s) decide_turns();
  } else {
    at_floor_s_ = at_floor_ = 0;
  }
  frames_s_.push_back(frame_s);
  if (frames_s_.size() < 3 || std::accumulate(frames_s_.begin(), frames_s_.end(), 0.0) < kPeriod_s) return;
  // The median, because a frame that waited for a shader compiler, a file or another program does not predict the next.
  const auto middle = frames_s_.begin() + std::ptrdiff_t(frames_s_.size() / 2);
  std::nth_element(frames_s_.begin(), middle, frames_s_.end());
  decide(*middle);
  frames_s_.clear();
}

void QualityGovernor::decide_turns() {
  const double share = at_floor_s_ / at_floor_ / kFrame_s;
  const int before = turns_of_motion_;
  if (share > (waits_for_screen_ ? kSlow : kSlowInTheMean))
    turns_of_motion_ = std::min(turns_of_motion_ + 1, kFewestTurns);
  else if (share < kQuickInTheMean)
    turns_of_motion_ = std::max(turns_of_motion_ - 1, kFewTurns);
  if (turns_of_motion_ != before) frames_s_.clear();
  at_floor_s_ = at_floor_ = 0;
}

void QualityGovernor::decide(double frame_s) {
  const double share = frame_s / kFrame_s;
  if (share > kSlow) {
    if (turns_of_motion_ < kFewTurns)
      turns_of_motion_ = share > kMuchTooSlow ? kFewTurns : turns_of_motion_ + 1;
    else
      of_motion_ = std::max(kMin, of_motion_ * std::max(kMinStep, std::sqrt(kAim / share)));
  } else if (turns_of_motion_ > kFewTurns) {
    return;  // decide_turns() gives the other views their turns again before there are more pixels
  } else if (share < kQuick && of_motion_ < 1) {
    of_motion_ = std::min(1.0, of_motion_ * std::min(kMaxStep, std::sqrt(kAim / share)));
  } else if (share < (turns_of_motion_ == kFewTurns ? kQuick : kQuickForAllViews)) {
    turns_of_motion_ = std::max(0, turns_of_motion_ - 1);
  }
}

}  // namespace insonate
