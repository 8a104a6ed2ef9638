#include "devices/synthetic/synthetic_tracker.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "devices/live/live_tracker.h"
#include "devices/live/paced_source.h"
#include "devices/synthetic/least_jerk.h"
#include "sim/core/hash.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

// Physiological tremor of a hand: 8 to 12 Hz and about 0.1 mm (Elble and Koller, Tremor, 1990).
constexpr double kTremor_mm = 0.1;
constexpr double kTremor_hz[] = {8.3, 9.7, 11.6};
// Static noise of a magnetic tracker in a clean field is 0.08 to 0.3 mm; uniform noise in +-0.15 mm is 0.087 mm RMS.
constexpr double kNoise_mm = 0.15;
constexpr double kDropoutsPerSecond = 0.08;

// Purpose of a random number.
enum Purpose : std::uint32_t {
  kDuration,
  kPause,
  kKind,
  kAround,
  kAlong,
  kRoll,
  kTilt,
  kRock,
  kTremor,
  kNoiseX,
  kNoiseY,
  kNoiseZ,
  kDropout,
  kDropoutBegin,
  kDropoutLength,
  kDropoutStatus,
};

double between(double least, double most, double t) {
  return least + (most - least) * t;
}

}  // namespace

SyntheticTracker::SyntheticTracker(std::uint32_t seed, double rate_hz, const TrackerContext& body)
    : Tracker("synthetic hand " + std::to_string(seed)), seed_(seed), rate_hz_(rate_hz), body_(body) {
  if (!glm::all(glm::greaterThan(body.body_max, body.body_min)))
    throw std::invalid_argument("the body's bounding box is empty");
  move_.to = {.around = 0, .along = 0.5};
  move_.from = move_.to;
}

double SyntheticTracker::random(std::uint32_t purpose, std::uint32_t number) const {
  return double(unit_float(hash(seed_, purpose, number, 0)));
}

SyntheticTracker::Move SyntheticTracker::move_after(const Move& before) const {
  Move move;
  const std::uint32_t n = move.number = before.number + 1;
  move.begin_s = before.begin_s + before.duration_s + before.pause_s;
  move.duration_s = between(1.2, 4.0, random(kDuration, n));
  move.pause_s = between(0.2, 1.2, random(kPause, n));
  move.from = move.to = before.to;
  // Half of the moves glide to another place; the others only tilt and rock the probe on the spot.
  if (random(kKind, n) < 0.5) {
    move.to.around = between(-0.9, 0.9, random(kAround, n));
    move.to.along = between(0.25, 0.75, random(kAlong, n));
    move.to.roll = between(0, glm::half_pi<double>(), random(kRoll, n));
  }
  move.to.tilt = glm::radians(between(-20, 20, random(kTilt, n)));
  move.to.rock = glm::radians(between(-10, 10, random(kRock, n)));
  return move;
}

SyntheticTracker::Contact SyntheticTracker::contact_at(double time_s) {
  while (time_s >= move_.begin_s + move_.duration_s + move_.pause_s) move_ = move_after(move_);
  const double t = least_jerk(std::min((time_s - move_.begin_s) / move_.duration_s, 1.0));
  const Contact &a = move_.from, &b = move_.to;
  return {between(a.around, b.around, t), between(a.along, b.along, t), between(a.roll, b.roll, t),
          between(a.tilt, b.tilt, t), between(a.rock, b.rock, t)};
}

Pose SyntheticTracker::pose_at(const Contact& contact) const {
  const glm::dvec3 centre = (body_.body_min + body_.body_max) / 2.0;
  const glm::dvec3 half = (body_.body_max - body_.body_min) / 2.0;
  const double s = std::sin(contact.around), c = std::cos(contact.around);
  const glm::dvec3 skin(centre.x + half.x * s, centre.y - half.y * c,
                        between(body_.body_min.z, body_.body_max.z, contact.along));
  const glm::dvec3 to_right = -glm::normalize(glm::dvec3(half.x * c, half.y * s, 0));
  const glm::dvec3 inward = -glm::normalize(glm::dvec3(s / half.x, -c / half.y, 0));
  const glm::dmat3 level(to_right, inward, glm::cross(to_right, inward));
  const glm::dquat turn = glm::angleAxis(contact.roll, glm::dvec3(0, 1, 0)) *
                          glm::angleAxis(contact.tilt, glm::dvec3(1, 0, 0)) *
                          glm::angleAxis(contact.rock, glm::dvec3(0, 0, 1));
  return {level * glm::mat3_cast(turn), skin};
}

Pose SyntheticTracker::trembling(const Pose& pose, std::uint32_t index, double time_s) const {
  glm::dvec3 shake(0);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    for (std::uint32_t wave = 0; wave < 3; ++wave) {
      const double phase = random(kTremor, axis * 3 + wave);
      shake[int(axis)] += kTremor_mm / 3 * std::sin(glm::two_pi<double>() * (kTremor_hz[wave] * time_s + phase));
    }
    shake[int(axis)] += between(-kNoise_mm, kNoise_mm, random(kNoiseX + axis, index));
  }
  return {pose.rotation, pose.translation + shake};
}

PoseStatus SyntheticTracker::status_at(double time_s) const {
  // At most one dropout begins in each second; it may continue into the next.
  const double second = std::floor(time_s);
  for (const double slot : {second, second - 1}) {
    if (slot < 1) continue;
    const auto n = std::uint32_t(slot);
    if (random(kDropout, n) >= kDropoutsPerSecond) continue;
    const double begin = slot + random(kDropoutBegin, n);
    if (time_s < begin || time_s >= begin + between(0.05, 0.5, random(kDropoutLength, n))) continue;
    return random(kDropoutStatus, n) < 0.5 ? PoseStatus::missing : PoseStatus::out_of_view;
  }
  return PoseStatus::ok;
}

void SyntheticTracker::collect(double now_s, std::vector<ProbeSample>& samples) {
  if (!start_s_) start_s_ = now_s;
  for (;; ++next_) {
    ProbeSample sample;
    sample.time_s = double(next_) / rate_hz_;
    if (sample.time_s > now_s - *start_s_) return;
    const Contact contact = contact_at(sample.time_s);
    sample.status = status_at(sample.time_s);
    if (sample.status == PoseStatus::ok) sample.patient_from_probe = trembling(pose_at(contact), next_, sample.time_s);
    samples.push_back(sample);
  }
}

std::unique_ptr<Tracker> open_synthetic(const TrackerUri& uri, const TrackerContext& context) {
  uri.allow_options({"rate", "live"});
  std::uint32_t seed = 1;
  const char* const end = uri.subject.data() + uri.subject.size();
  if (!uri.subject.empty())
    if (const auto read = std::from_chars(uri.subject.data(), end, seed); read.ec != std::errc() || read.ptr != end)
      throw InputError("tracker '" + uri.text + "'", "",
                       "the seed '" + uri.subject + "' is not a whole number below 2^32",
                       "write it as in 'synthetic:7'");
  const double rate_hz = uri.number("rate", 60, 1, 1000);
  auto hand = std::make_unique<SyntheticTracker>(seed, rate_hz, context);
  if (!uri.flag("live", false)) return hand;
  return std::make_unique<LiveTracker>(std::make_unique<PacedSource>(
      "made-up hand, live",
      [hand = std::shared_ptr<SyntheticTracker>(std::move(hand)), rate_hz](std::uint64_t index) {
        // Polls in the middle between two samples, so that rounding neither skips nor doubles one.
        std::vector<ProbeSample> one;
        hand->poll(index == 0 ? 0 : (double(index) + 0.5) / rate_hz, one);
        return one.at(0);
      },
      rate_hz));
}

}  // namespace insonate
