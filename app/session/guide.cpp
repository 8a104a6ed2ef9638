#include "app/session/guide.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenarios/guidance.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

/// A slide as its arrow keys make it, and the way in words: the key of its larger part, and a second one if that part
/// is at least half as large.
struct KeyedSlide {
  std::string keys, way;
};

KeyedSlide keyed(const glm::dvec3& slide_mm, const Pose& pose) {
  const auto along_key = [&](const glm::dvec2& key) {
    const glm::dvec2 mm = ProbeHand::slide_in_patient(pose, key);
    return pose.rotation * glm::dvec3(mm.x, 0, mm.y);
  };
  const glm::dvec3 around_key = along_key({1, 0});
  const double around = glm::dot(slide_mm, around_key), up = glm::dot(slide_mm, along_key({0, 1}));
  const glm::dvec3 to = around > 0 ? around_key : -around_key;  // to a side, or on the flank to front or back
  const std::string side = std::abs(to.x) >= std::abs(to.y) ? (to.x > 0 ? "the patient's left" : "the patient's right")
                                                            : (to.y > 0 ? "the back" : "the front");
  const KeyedSlide across{around > 0 ? "\u2192" : "\u2190", side},
      along{up > 0 ? "\u2191" : "\u2193", up > 0 ? "the head" : "the feet"};
  const bool turned = std::abs(around) > std::abs(up);
  const KeyedSlide &more = turned ? across : along, &less = turned ? along : across;
  if (std::min(std::abs(around), std::abs(up)) < std::max(std::abs(around), std::abs(up)) / 2) return more;
  return {more.keys + " " + less.keys, more.way + " and " + less.way};
}

/// Returns the keys of each part that in_words() mentions, as Keyboard moves the probe.
std::vector<std::string> keys_of(const GuidingMove& move, const Pose& pose, const GuidingLimits& limits) {
  std::vector<std::string> keys;
  if (glm::length(move.slide_mm) > limits.slide_mm) keys.push_back(keyed(move.slide_mm, pose).keys);
  if (std::abs(move.rotation_deg) > limits.turn_deg) keys.emplace_back(move.rotation_deg > 0 ? "E" : "Q");
  if (std::abs(move.tilt_deg) > limits.turn_deg) keys.emplace_back(move.tilt_deg > 0 ? "D" : "A");
  if (std::abs(move.rock_deg) > limits.turn_deg) keys.emplace_back(move.rock_deg > 0 ? "W" : "S");
  return keys;
}

constexpr GuidingLimits kFinely{1, 1};

/// Fills in the movements that are above the limits.
void advise(Guiding& guiding, const Session& session, const Pose& pose, const GuidingLimits& limits) {
  const Pose& reference = guiding.view->patient_from_probe;
  GuidingMove move = move_to(pose, reference);
  Pose slid_to = pose;
  // A hand slides over the skin and keeps the probe's angle to it, so the turns are those that are left then.
  if (const auto slide = ProbeHand(session.loaded_case().subject.ct).slide_to(pose, reference)) {
    if (glm::length(slide->way_mm) > limits.slide_mm) slid_to = slide->pose;
    move = move_to(slid_to, reference);
    move.slide_mm = slide->way_mm;
  }
  guiding.advice = in_words(move, slid_to, limits);
  guiding.slides = glm::length(move.slide_mm) > limits.slide_mm;
  if (session.holder() != Holder::learner) return;
  guiding.keys = keys_of(move, pose, limits);
  // The words and the keys name the same ways.
  if (guiding.slides)
    guiding.advice.front() =
        formatted("Slide %.0f mm towards ", glm::length(move.slide_mm)) + keyed(move.slide_mm, pose).way + ".";
}

}  // namespace

const ReferenceView* Guide::find_view(const LoadedCase& loaded_case, const std::string& name) const {
  const auto made = std::find_if(made_.begin(), made_.end(), [&](const ReferenceView& v) { return v.name == name; });
  return made == made_.end() ? loaded_case.subject.find_view(name) : &*made;
}

std::vector<std::string> Guide::names(const LoadedCase& loaded_case) const {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (find_view(loaded_case, name) && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  };
  if (loaded_case.scenario)
    for (const Step& step : loaded_case.scenario->steps) add(step.view);
  for (const ReferenceView& view : loaded_case.subject.views) add(view.name);
  for (const ReferenceView& view : made_) add(view.name);
  return names;
}

/// Returns the view that the current step asks for; empty if it asks for none, nullptr if no step is in progress.
const std::string* Guide::view_of_step(const Session& session) {
  const Runner* runner = session.runner();
  if (!runner || runner->live().finished) return nullptr;
  return &runner->scenario().steps[runner->live().step].view;
}

bool Guide::can_lead(const Session& session) const {
  const std::string* of_step = view_of_step(session);
  return of_step ? !of_step->empty() : !names(session.loaded_case()).empty();
}

void Guide::next(const Session& session) {
  if (session.strict() || !can_lead(session)) return;
  if (view_of_step(session)) {
    in_run_ = !in_run_;
    return;
  }
  const std::vector<std::string> views = names(session.loaded_case());
  auto at = std::find(views.begin(), views.end(), view_);
  at = at == views.end() ? views.begin() : at + 1;
  view_ = at == views.end() ? std::string() : *at;
}

void Guide::report_use(Session& session) {
  if (std::exchange(reported_attempt_, session.attempt()) != session.attempt()) reported_on_ = false;
  if (session.strict() || !view_of_step(session) || reported_on_ == in_run_) return;
  reported_on_ = in_run_;
  session.act({ActionKind::guide, {double(in_run_)}});
}

std::optional<Guiding> Guide::now(const Session& session) const {
  if (session.strict()) return std::nullopt;
  const std::string* of_step = view_of_step(session);
  if (of_step && !in_run_) return std::nullopt;
  const ReferenceView* view = find_view(session.loaded_case(), of_step ? *of_step : view_);
  const std::optional<Pose>& pose = session.newest_pose();
  if (!view || !pose) return std::nullopt;
  Guiding guiding;
  guiding.view = view;
  // A step has its own tolerances. Where they are not met yet, the guide leads on to the very place.
  const LiveExam* live = of_step ? &session.runner()->live() : nullptr;
  advise(guiding, session, *pose, {});
  if (live && !live->within_tolerance && guiding.advice.empty()) {
    advise(guiding, session, *pose, kFinely);
    if (guiding.advice.empty())
      guiding.advice = {"The probe is in place. " + (live->lacks.empty() ? "Look at depth and knobs." : live->lacks)};
  }
  guiding.there = (live && live->within_tolerance) || guiding.advice.empty();
  const glm::dvec3 middle(0, view->depth_mm / 2, 0), normal = view->patient_from_probe.rotation[2];
  guiding.plane_distance_mm = std::abs(glm::dot(pose->point(middle) - view->patient_from_probe.point(middle), normal));
  const double cosine = glm::dot(pose->rotation[2], normal);
  guiding.plane_angle_deg = glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
  if (live && live->view) {  // as the step measures them
    guiding.plane_distance_mm = std::abs(live->view->plane_distance_mm);
    guiding.plane_angle_deg = live->view->plane_angle_deg;
  }
  return guiding;
}

}  // namespace insonate
