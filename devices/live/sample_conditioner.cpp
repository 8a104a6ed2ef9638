#include "devices/live/sample_conditioner.h"

#include <algorithm>
#include <cmath>

namespace insonate {

void SampleConditioner::apply(ProbeSample& sample, const std::optional<glm::dvec3>& origin) {
  // Samples of one report share a time, and the clock may be read in a different order than samples are published.
  sample.time_s = std::max(sample.time_s, std::nextafter(last_time_s_, HUGE_VAL));
  last_time_s_ = sample.time_s;
  filters_.apply(sample, origin);
}

ProbeSample silence_at(double time_s) {
  ProbeSample silence;
  silence.time_s = time_s;
  silence.status = PoseStatus::missing;
  return silence;
}

}  // namespace insonate
