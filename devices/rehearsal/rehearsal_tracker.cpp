#include "devices/rehearsal/rehearsal_tracker.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "devices/synthetic/least_jerk.h"
#include "sim/core/hash.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr std::uint32_t kSeed = 1;
constexpr double kNoise_mm = 0.15, kTouchError_mm = 1.5;

const glm::dvec3 kRight(-1, 0, 0), kUp(0, -1, 0);

Pose turned(double deg, const glm::dvec3& axis, const glm::dvec3& at) {
  return {glm::mat3_cast(glm::angleAxis(glm::radians(deg), glm::normalize(axis))), at};
}

/// The lab: the tracker's base stands beside the table, and the sensor sits in the handle.
const Pose& patient_from_tracker() {
  static const Pose pose = turned(25, {1, 2, 3}, {320, -60, -40});
  return pose;
}
const Pose& sensor_from_face() {
  static const Pose pose = turned(70, {-1, 0.4, 2}, {8, -21, 90});
  return pose;
}
const glm::dvec3 kDimple(280, 60, -60), kCorner(290, 40, 120), kKey(270, 60, 30);

/// Places of the probe, in the frame of its face: a curvilinear face whose middle is ahead of its ends.
const glm::dvec3 kTip(36, -18, 6);
const std::array<glm::dvec3, 5> kTouched{kTip, glm::dvec3(0), glm::dvec3(30, -12, 0), glm::dvec3(-30, -12, 0),
                                         glm::dvec3(0, -131, 0)};

Pose held(const glm::dvec3& marker, const glm::dvec3& beam, const glm::dvec3& face) {
  return {glm::dmat3(marker, beam, glm::cross(marker, beam)), face};
}

/// Moves a pose so that a place of the probe is at a place of the lab.
Pose touching(Pose pose, const glm::dvec3& of_probe, const glm::dvec3& place) {
  pose.translation = place - pose.rotation * of_probe;
  return pose;
}

/// Returns three random numbers within +-reach.
glm::dvec3 random(std::uint32_t purpose, std::uint32_t number, double reach) {
  glm::dvec3 r(0);
  for (std::uint32_t axis = 0; axis < 3; ++axis)
    r[int(axis)] = reach * (2 * double(unit_float(hash(kSeed, purpose, number, axis))) - 1);
  return r;
}

Pose between(const Pose& a, const Pose& b, double t) {
  return {glm::mat3_cast(glm::slerp(glm::quat_cast(a.rotation), glm::quat_cast(b.rotation), t)),
          glm::mix(a.translation, b.translation, t)};
}

/// Tilts a probe about its tip to all sides and turns it about its length.
Pose pivoted(const Pose& upright, double seconds) {
  const double grown = least_jerk(std::min(seconds, 1.0)), round = glm::two_pi<double>() * seconds / 4;
  const Pose tilt = turned(grown * kPivotTilt_deg, {std::cos(round), 0, std::sin(round)}, glm::dvec3(0));
  const Pose roll = turned(grown * 40 * std::sin(0.7 * round), {0, 1, 0}, glm::dvec3(0));
  return touching({upright.rotation * tilt.rotation * roll.rotation, {}}, kTip, upright.point(kTip));
}

constexpr double kLifted_mm = 40;

/// Returns the probe's height above the key `seconds` after it began to fall from `from_mm`: it strikes, rests, and is
/// lifted again.
double height_mm(double from_mm, double seconds) {
  constexpr double kFall_s = RehearsalTracker::kFall_s, kRest_s = 0.15, kLift_s = 0.3;
  if (seconds < kFall_s) return from_mm * (1 - std::pow(seconds / kFall_s, 2));
  return kLifted_mm * least_jerk(std::clamp((seconds - kFall_s - kRest_s) / kLift_s, 0.0, 1.0));
}

}  // namespace

RehearsalTracker::RehearsalTracker(const TrackerContext& body, bool raw)
    : Tracker("made-up hand"),
      body_(body),
      placement_(body.start, raw),
      scanning_(kSeed, kRate_hz, body),
      last_seen_(body.start) {}

Pose RehearsalTracker::patient_from_probe(const Pose& tracker_from_sensor) {
  return patient_from_tracker() * tracker_from_sensor * sensor_from_face();
}

Pose RehearsalTracker::wanted() const {
  const glm::dvec3 middle = (body_.body_min + body_.body_max) / 2.0;
  const glm::dvec3 belly(middle.x, body_.body_min.y, middle.z);
  const Pose upright = held(kRight, -kUp, belly);
  const std::size_t part = task_->part;
  if (task_->step == "axes") {
    const AskedMove& move = asked_moves()[std::min<std::size_t>(part / 2, 3)];
    return held(move.marker, move.beam, belly + 30.0 * kUp + (part % 2 == 1 ? 120.0 : 0.0) * move.way);
  }
  if (task_->step == "pivot") return touching(upright, kTip, kDimple);
  if (task_->step == "face") {
    const std::size_t touch = std::min(part, kTouched.size() - 1);
    const bool is_tail = touch + 1 == kTouched.size();
    return touching(is_tail ? held(kRight, kUp, belly) : upright, kTouched[touch],
                    kCorner + random(0, std::uint32_t(touch), 0.2));
  }
  if (task_->step == "landmarks" && task_->landmark_mm) {
    const glm::dvec3 place = *task_->landmark_mm;
    const glm::dvec3 inward = glm::normalize(glm::dvec3(middle.x - place.x, middle.y - place.y, 0));
    return touching(held({-inward.y, inward.x, 0}, inward, place), kTip,
                    place + random(1, std::uint32_t(part), kTouchError_mm));
  }
  return held(kRight, -kUp, kKey + kLifted_mm * kUp);
}

void RehearsalTracker::follow(std::string_view step, const SetupView& view) {
  if (view.done && task_ && task_->step == step) {
    task_->done = true;
    return;
  }
  const Task task{std::string(step), view.part, view.reading, view.done, view.landmark_mm};
  if (task_ && task == *task_) return;
  const double now_s = time_s();
  const Pose here = pose_at(now_s);
  const bool is_struck = task_ && task_->step == step && step == "lag" && view.part > task_->part;
  if (is_struck) {
    from_height_mm_ = struck_s_ ? height_mm(from_height_mm_, now_s - *struck_s_) : kLifted_mm;
    struck_s_ = now_s;
  } else if (!task_ || task_->step != step) {
    struck_s_.reset();
  }
  const bool is_first = !task_;
  task_ = task;
  began_s_ = now_s;
  const Pose goal = wanted();
  if (!is_first && goal == to_) return;
  from_ = here;
  to_ = goal;
  moved_s_ = now_s;
}

bool RehearsalTracker::is_there() const {
  return task_ && time_s() >= moved_s_ + kReach_s;
}

std::string RehearsalTracker::doing() const {
  if (!task_ || task_->done) return "";
  if (!is_there()) return "The made-up hand is on its way.";
  if (task_->step == "lag") return "The made-up hand strikes when you press the key.";
  if (task_->step == "pivot" && task_->reading) return "The made-up hand pivots.";
  if (task_->step != "axes" && task_->reading) return "The made-up hand holds still.";
  return "The made-up hand is there: mark.";
}

Pose RehearsalTracker::pose_at(double time_s) const {
  if (!task_) return last_seen_;
  Pose pose = between(from_, to_, least_jerk(std::clamp((time_s - moved_s_) / kReach_s, 0.0, 1.0)));
  if (task_->step == "pivot" && task_->reading) pose = pivoted(pose, time_s - began_s_);
  if (struck_s_) pose.translation += (height_mm(from_height_mm_, time_s - *struck_s_) - kLifted_mm) * kUp;
  return pose;
}

void RehearsalTracker::collect(double now_s, std::vector<ProbeSample>& samples) {
  if (!start_s_) start_s_ = now_s;
  polled_.clear();
  scanning_.poll(now_s, polled_);
  for (ProbeSample& sample : polled_) {
    if (!task_) {
      if (sample.status == PoseStatus::ok) last_seen_ = sample.patient_from_probe;
    } else {
      sample.status = PoseStatus::ok;
      sample.patient_from_probe = pose_at(sample.time_s);
      sample.patient_from_probe.translation += random(2, next_, kNoise_mm);
    }
    ++next_;
    samples.push_back(sample);
    if (sample.status == PoseStatus::ok)
      samples.back().patient_from_probe = placement_.patient_from_probe(
          patient_from_tracker().inverse() * sample.patient_from_probe * sensor_from_face().inverse());
  }
}

std::unique_ptr<Tracker> open_rehearsal(const TrackerUri& uri, const TrackerContext& context) {
  uri.allow_options({"raw"});
  if (!uri.subject.empty())
    throw InputError("tracker '" + uri.text + "'", "", "the rehearsal needs no name", "write just 'rehearsal:'");
  return std::make_unique<RehearsalTracker>(context, uri.flag("raw", false));
}

}  // namespace insonate
