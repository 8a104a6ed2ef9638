#include "app/pictures/quality_governor.h"

#include <algorithm>
#include <utility>

namespace insonate {
namespace {

/// A change needs a majority among this many frames. A few frames that waited for a shader compiler, a file or another
/// program do not predict the next ones.
constexpr int kWindow = 20;
constexpr double kStep = 0.85;
constexpr double kSlow_s = 0.045;
/// Fast enough that one step up, which costs at most 1 / kStep^2 = 1.4 times as much, is not slow again.
constexpr double kQuick_s = 0.6 * kSlow_s;

}  // namespace

void QualityGovernor::see(double now_s, double frame_s, bool computed) {
  const bool follows = std::exchange(computed_before_, computed) || now_s - computed_s_ < kRest_s;
  if (!computed) {
    moves_ = moves_ && follows;
    return;
  }
  if (moves_) see_motion(frame_s);
  // A single new picture is not motion: it follows a changed setting, or it is the full-resolution picture after a
  // motion.
  moves_ = follows;
  computed_s_ = now_s;
}

void QualityGovernor::see_motion(double frame_s) {
  slow_ += frame_s > kSlow_s ? 1 : 0;
  quick_ += frame_s < kQuick_s ? 1 : 0;
  if (++frames_ < kWindow) return;
  if (2 * slow_ > kWindow) of_motion_ = std::max(kLeast, of_motion_ * kStep);
  if (2 * quick_ > kWindow) of_motion_ = std::min(1.0, of_motion_ / kStep);
  frames_ = slow_ = quick_ = 0;
}

}  // namespace insonate
