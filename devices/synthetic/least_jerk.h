#pragma once

namespace insonate {

/// Returns the progress of a hand's reaching movement, from 0 to 1, at the share `t` of its time: the minimum-jerk path
/// (Flash and Hogan, J. Neurosci. 1985).
inline double least_jerk(double t) {
  return t * t * t * (10 - 15 * t + 6 * t * t);
}

}  // namespace insonate
