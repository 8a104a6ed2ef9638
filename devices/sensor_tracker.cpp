#include "devices/sensor_tracker.h"

namespace insonate {

SensorSample sensor_sample(const ProbeSample& raw) {
  return {raw.time_s, raw.status, raw.patient_from_probe, raw.buttons, raw.distortion, raw.rejected};
}

void SensorTracker::poll(double now_s, std::vector<SensorSample>& samples) {
  polled_.clear();
  raw_->poll(now_s, polled_);
  for (const ProbeSample& raw : polled_) samples.push_back(sensor_sample(raw));
}

}  // namespace insonate
