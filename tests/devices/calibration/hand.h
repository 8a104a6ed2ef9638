#pragma once

#include <vector>

#include "devices/calibration/axes.h"
#include "devices/calibration/face.h"
#include "devices/calibration/registration.h"
#include "devices/calibration/sensor_sample.h"
#include "tests/devices/calibration/synthetic.h"

namespace insonate {

/// A simulated lab, and a hand that performs the whole set-up in it. It generates the tracker's samples, with a button
/// press at each mark.
struct Lab {
  Pose ct_from_tracker = {turned(40, {1, 2, 3}).rotation, {120, -340, 60}};
  Pose sensor_from_face = {turned(110, {-1, 0.4, 2}).rotation, {8, -21, 90}};
  FacePoints face{{0, 0, 0}, {30, -12, 0}, {-30, -12, 0}, {0, -150, 0}};  ///< in the face's frame
  glm::dvec3 tip{40, -20, 6};                                             ///< in the face's frame
  glm::dvec3 dimple{300, -50, -100}, corner{280, -80, 150};               ///< in the CT's frame
  AxisSigns wrong;        ///< axes that the tracker reports with the wrong sign
  double noise_mm = 0.1;  ///< noise of its positions, along each axis
  double rate_hz = 60;
};

class Hand {
public:
  Hand(const Lab& lab, std::uint32_t seed) : lab_(lab), dice_(seed) {}

  /// Holds the probe for a time. With `mark` its button goes down at the beginning.
  void hold(const Pose& ct_from_face, double seconds, bool mark = false) {
    for (double end_s = time_s_ + seconds; time_s_ < end_s; mark = false) add(ct_from_face, mark);
  }

  void axes() {
    const glm::dvec3 right(-1, 0, 0), up(0, -1, 0), head(0, 0, 1);
    const auto held = [](const glm::dvec3& marker, const glm::dvec3& beam) {
      return Pose{glm::dmat3(marker, beam, glm::cross(marker, beam)), {0, -150, 0}};
    };
    const auto move = [&](Pose pose, const glm::dvec3& way) {
      hold(pose, 0.2, true);
      pose.translation += 120.0 * way;
      hold(pose, 0.2, true);
    };
    move(held(right, -up), right);
    move(held(right, -up), up);
    move(held(head, -up), head);
    move(held(up, right), up);
  }

  /// @param slip_mm  how far the tip moves from its place, along each axis
  void pivot(double seconds, double slip_mm = 0) {
    bool mark = true;
    for (const Pose& pose :
         pivoting(dice_, dice_.pose(1), lab_.tip, lab_.dimple, 35, 60, int(seconds * lab_.rate_hz), slip_mm)) {
      add(pose, mark);
      mark = false;
    }
  }

  void face() {
    for (const glm::dvec3& point :
         {lab_.tip, lab_.face.middle, lab_.face.marker_end, lab_.face.other_end, lab_.face.tail})
      touch(lab_.corner, point);
  }

  void landmarks(const std::vector<LandmarkPair>& pairs, double error_mm) {
    for (const LandmarkPair& pair : pairs) touch(pair.ct_mm + dice_.noise(error_mm), lab_.tip);
  }

  /// Strikes the button's place with uneven pauses. The tracker shows it `lag_s` later.
  void knocks(double lag_s) {
    const double begin_s = time_s_;
    std::vector<double> blows;
    for (double at_s = begin_s + 1; blows.size() < 10; at_s += dice_.uniform(0.6, 1.3)) blows.push_back(at_s);
    std::size_t next = 0;
    while (time_s_ < blows.back() + 2) {
      double height = 0;
      for (const double at_s : blows) {
        const double before_s = at_s - (time_s_ - lag_s);
        if (before_s >= 0 && before_s < 0.12) height = 40 * (1 - std::pow(1 - before_s / 0.12, 2));
        if (before_s >= 0.12 && before_s < 0.42) {
          const double raising = (0.42 - before_s) / 0.3;
          height = 40 * (3 - 2 * raising) * raising * raising;
        }
      }
      const bool blow = next < blows.size() && time_s_ >= blows[next];
      next += blow;
      add(Pose{glm::dmat3(1), {0, -150 - height, 0}}, blow);
    }
  }

  const std::vector<SensorSample>& samples() const { return samples_; }

private:
  void touch(const glm::dvec3& place, const glm::dvec3& point_of_probe) {
    Pose pose = dice_.pose(1);
    pose.translation = place - pose.rotation * point_of_probe;
    hold(pose, 0.7, true);
  }

  void add(const Pose& ct_from_face, bool mark) {
    Pose pose = lab_.ct_from_tracker.inverse() * ct_from_face * lab_.sensor_from_face.inverse();
    pose.translation += dice_.noise(lab_.noise_mm);
    samples_.push_back({time_s_, PoseStatus::ok, lab_.wrong.apply(pose), mark ? 1u : 0u});
    time_s_ += 1 / lab_.rate_hz;
  }

  Lab lab_;
  Dice dice_;
  std::vector<SensorSample> samples_;
  double time_s_ = 0;
};

/// Returns the samples in the form in which a tracker that does not place the probe delivers and records them.
inline std::vector<ProbeSample> as_raw(const std::vector<SensorSample>& samples) {
  std::vector<ProbeSample> raw;
  for (const SensorSample& s : samples)
    raw.push_back({s.time_s, s.status, s.tracker_from_sensor, s.buttons, s.distortion, s.rejected});
  return raw;
}

}  // namespace insonate
