#include "tools/make_log/hand.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/tissue/skin_contact.h"
#include "tools/make_log/act.h"

namespace insonate {
namespace {

/// A sequence of random numbers from one seed.
class Random {
public:
  explicit Random(std::uint32_t seed) : seed_(seed) {}
  double uniform() { return (double(hash(seed_, next_++)) + 0.5) / 4294967296.0; }
  double normal() { return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * std::numbers::pi * uniform()); }
  glm::dvec3 normal3() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }

private:
  std::uint32_t seed_;
  std::uint32_t next_ = 0;
};

/// A smooth random signal around 0 with about the given amplitude: the sum of a few sines whose frequencies have no
/// common period.
class Wander {
public:
  Wander(Random& random, double least_hz, double most_hz) {
    for (Wave& wave : waves_)
      wave = {least_hz + (most_hz - least_hz) * random.uniform(), 2 * std::numbers::pi * random.uniform()};
  }
  double at(double time_s) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(2 * std::numbers::pi * wave.hz * time_s + wave.phase);
    return sum / 2;  // four sines of random phase: standard deviation 0.7
  }

private:
  struct Wave {
    double hz;
    double phase;
  };
  std::array<Wave, 4> waves_;
};

glm::dmat3 turn(double degrees, const glm::dvec3& axis) {
  return glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis));
}

glm::dmat3 turn(double tilt_deg, double rock_deg, double rotation_deg) {
  return turn(tilt_deg, {1, 0, 0}) * turn(rock_deg, {0, 0, 1}) * turn(rotation_deg, {0, 1, 0});
}

/// The pose that the hand aims at, and its distance from the skin.
struct Aim {
  Pose pose;
  double lift_mm = 0;
};

Aim between(const Aim& a, const Aim& b, double share) {
  return {interpolate(a.pose, b.pose, share), a.lift_mm + (b.lift_mm - a.lift_mm) * share};
}

/// Minimum-jerk profile from 0 to 1.
double minimum_jerk(double share) {
  return share * share * share * (10 - 15 * share + 6 * share * share);
}

/// One section of the plan: from one aim to another, optionally with fanning.
struct Stretch {
  double seconds;
  Aim from;
  Aim to;
  double fan_deg = 0;
  std::string then{};  ///< action at its end

  Aim at(double time_s) const {
    const double share = std::clamp(time_s / seconds, 0.0, 1.0);
    Aim aim = between(from, to, minimum_jerk(share));
    if (fan_deg > 0)
      aim.pose.rotation = aim.pose.rotation * turn(fan_deg * std::sin(2 * std::numbers::pi * share), {1, 0, 0});
    return aim;
  }
};

Aim aim_of(const PlannedMove& move, const Case& subject) {
  const ReferenceView* view = subject.find_view(move.view);
  if (!view) {
    std::vector<std::string> names;
    for (const ReferenceView& v : subject.views) names.push_back(v.name);
    throw InputError(subject.name, "", "the view '" + move.view + "' is not in the case", suggest(move.view, names));
  }
  Pose off;
  off.rotation = turn(move.tilt_deg, move.rock_deg, move.rotation_deg);
  off.translation = {move.lateral_mm, 0, move.elevation_mm};
  return {view->patient_from_probe * off, move.lift_mm};
}

/// Returns the sections of the plan's moves. Each move is a reach that overshoots, corrections that remove half of the
/// error or more, the search and the rest.
std::vector<Stretch> stretches_of(const LogPlan& plan, const Case& subject, Random& random) {
  std::vector<Stretch> stretches;
  Aim here = aim_of(plan.moves.front(), subject);
  if (plan.moves.front().rest_s > 0) stretches.push_back({plan.moves.front().rest_s, here, here});
  for (std::size_t i = 1; i < plan.moves.size(); ++i) {
    const PlannedMove& move = plan.moves[i];
    const Aim goal = aim_of(move, subject);
    // The overshoot continues along the same path. The miss also has a random part.
    Aim reached = between(here, goal, 1 + move.overshoot);
    reached.lift_mm = goal.lift_mm;
    const double way_mm = std::min(60.0, glm::distance(here.pose.translation, goal.pose.translation));
    reached.pose.translation += move.overshoot * 0.2 * way_mm * random.normal3();
    stretches.push_back({move.seconds, here, reached});
    for (int k = 0; k < move.corrections; ++k) {
      const Aim corrected = k + 1 == move.corrections ? goal : between(reached, goal, 0.55 + 0.3 * random.uniform());
      stretches.push_back({0.1 + 0.2 * random.uniform(), reached, reached});  // the operator looks at the result
      stretches.push_back({0.35 + 0.3 * random.uniform(), reached, corrected});
      reached = corrected;
    }
    here = reached;
    if (move.search_s > 0) stretches.push_back({move.search_s, here, here, move.search_deg});
    double rested_s = 0;
    for (const std::string& doing : move.doing) {
      stretches.push_back({move.pause_s, here, here, 0, doing});
      rested_s += move.pause_s;
    }
    if (move.rest_s > rested_s) stretches.push_back({move.rest_s - rested_s, here, here});
  }
  return stretches;
}

/// Slides a pose along its beam until the face is pressed in, or hovers above the skin.
Pose on_skin(const Aim& aim, const Case& subject, double press_mm, double time_s) {
  constexpr double step_back_mm = 40;
  constexpr double far_mm = 400;
  const glm::dvec3 beam = aim.pose.rotation[1];
  glm::dvec3 outside = aim.pose.translation - step_back_mm * beam;
  while (distance_to_skin(subject.ct, outside, beam, 0) && glm::distance(outside, aim.pose.translation) < far_mm)
    outside -= step_back_mm * beam;
  const auto way = distance_to_skin(subject.ct, outside, beam, far_mm);
  if (!way) {
    char place[32];
    std::snprintf(place, sizeof place, "%.1f s into the log", time_s);
    throw InputError(subject.name, place, "the probe points past the body",
                     "bring the move's lateral_mm, elevation_mm and angles nearer to the view");
  }
  Pose pose = aim.pose;
  pose.translation = outside + (*way + press_mm - aim.lift_mm) * beam;
  return pose;
}

/// The small motion of a resting hand.
class Unsteadiness {
public:
  Unsteadiness(const LogPlan& plan, Random& random) : plan_(plan) {
    for (int c = 0; c < 3; ++c) {
      drift_.emplace_back(random, 0.08, 0.6);
      sway_.emplace_back(random, 0.08, 0.6);
      tremor_.emplace_back(random, 8, 12);  // physiological tremor of the hand
    }
  }
  Aim on(Aim aim, double time_s) const {
    const auto three = [&](const std::vector<Wander>& w) {
      return glm::dvec3(w[0].at(time_s), w[1].at(time_s), w[2].at(time_s));
    };
    aim.pose.translation +=
        aim.pose.rotation * (plan_.unsteadiness_mm * three(drift_) + plan_.tremor_mm * three(tremor_));
    const glm::dvec3 angles = plan_.unsteadiness_deg * three(sway_);
    aim.pose.rotation = aim.pose.rotation * turn(angles.x, angles.y, angles.z);
    return aim;
  }

private:
  const LogPlan& plan_;
  std::vector<Wander> drift_;
  std::vector<Wander> sway_;
  std::vector<Wander> tremor_;
};

PoseStatus status_at(const LogPlan& plan, double time_s) {
  for (const PlannedLoss& loss : plan.losses)
    if (time_s >= loss.at_s && time_s < loss.at_s + loss.for_s) return loss.status;
  return PoseStatus::ok;
}

Pose measured(const LogPlan& plan, Pose pose, Random& random) {
  pose.translation += plan.noise_mm * random.normal3();
  const glm::dvec3 angles = plan.noise_deg * random.normal3();
  pose.rotation = pose.rotation * turn(angles.x, angles.y, angles.z);
  return pose;
}

}  // namespace

MadeLog move_by_hand(const LogPlan& plan, const Case& subject) {
  Random moves(hash(plan.seed, 1));
  Random hand(hash(plan.seed, 2));
  Random tracker(hash(plan.seed, 3));
  const std::vector<Stretch> stretches = stretches_of(plan, subject, moves);
  const Unsteadiness unsteadiness(plan, hand);

  std::vector<ProbeSample> samples;
  ActionLog actions;
  double begin_s = 0;
  std::size_t current = 0;
  Pose picture;  // on the screen: the last valid one, or the one at which it was frozen
  bool frozen = false;
  for (std::size_t i = 0; current < stretches.size(); ++i) {
    const double time_s = double(i) / plan.rate_hz;
    while (current < stretches.size() && time_s >= begin_s + stretches[current].seconds) {
      begin_s += stretches[current].seconds;
      const std::string& then = stretches[current++].then;
      if (then.empty()) continue;
      const auto seen = std::find_if(samples.rbegin(), samples.rend(),
                                     [](const ProbeSample& sample) { return sample.status == PoseStatus::ok; });
      if (then == "freeze" || !frozen) picture = seen == samples.rend() ? Pose{} : seen->patient_from_probe;
      frozen = then == "freeze" || (frozen && then.find("unfreeze") == std::string::npos);
      const std::vector<Action> done = made_of(then, subject, picture);
      actions[time_s].insert(actions[time_s].end(), done.begin(), done.end());
    }
    if (current == stretches.size()) break;
    const Aim aim = unsteadiness.on(stretches[current].at(time_s - begin_s), time_s);
    ProbeSample sample;
    sample.time_s = time_s;
    sample.status = status_at(plan, time_s);
    sample.patient_from_probe = measured(plan, on_skin(aim, subject, plan.press_mm, time_s), tracker);
    samples.push_back(sample);
  }
  return {std::move(samples), std::move(actions)};
}

}  // namespace insonate
