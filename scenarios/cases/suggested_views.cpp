#include "scenarios/cases/suggested_views.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "scenarios/cases/acoustic_window.h"
#include "scenarios/cases/structures.h"
#include "scenarios/metrics/view_meter.h"

namespace insonate {
namespace {

constexpr double kBehind_mm = 20;  // shown beyond the deepest visible target, for orientation
constexpr double kMinDepth_mm = 80, kMaxDepth_mm = 240, kDepthStep_mm = 10;
const glm::dvec3 kHead(0, 0, 1), kRight(-1, 0, 0);

/// A candidate for a view.
struct Plan {
  std::string name, title;
  std::vector<std::string> targets;
  WantedPicture wanted;
};

std::string whole_percent(double share) {
  return std::to_string(std::lround(100 * share)) + " %";
}

std::string lower_first(std::string text) {
  text[0] = char(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

void plan_organ(const StructureShape& organ, std::vector<Plan>& plans) {
  const std::string& name = organ.label.name;
  const std::string title = title_of_structure(name);
  const auto add = [&](const char* which, const glm::dvec3& axis, bool along) {
    plans.push_back(
        {name + "_" + which, title + ", " + which + " axis", {name}, {organ.centre, axis, along, {organ.label.value}}});
  };
  // Bladder and prostate lie in the midline and change their shape from hour to hour. They are scanned in the planes of
  // the body.
  const bool by_body = name == "urinary_bladder" || name == "prostate";
  add("long", by_body ? kRight : organ.axes[0], !by_body);
  add("short", by_body ? kHead : organ.axes[0], false);
}

Plan plan_across(const Vessel& vessel, const VesselLevel& level) {
  const Label& label = vessel.shape->label;
  return {label.name + "_transverse_" + level.name,
          title_of_structure(label.name) + " across, " + level.title,
          {label.name},
          {level.point, level.along, false, {label.value}}};
}

Plan plan_along(const Vessel& vessel, const VesselLevel& level) {
  const Label& label = vessel.shape->label;
  return {label.name + "_long",
          title_of_structure(label.name) + ", long axis",
          {label.name},
          {level.point, level.along, true, {label.value}}};
}

Plan plan_recess(const Recess& recess) {
  const Label &organ = recess.organ->label, &kidney = recess.kidney->label;
  return {recess.name,
          title_of_structure(recess.name) + " recess, between " + lower_first(title_of_structure(organ.name)) +
              " and " + lower_first(title_of_structure(kidney.name)),
          {organ.name, kidney.name},
          {recess.point, recess.kidney->axes[0], true, {organ.value, kidney.value}}};
}

/// Returns the landmarks in the view's picture that belong to its targets or to the view itself.
std::vector<std::string> landmarks_in(const Case& subject, const Probe& probe, const ReferenceView& view) {
  constexpr double kOnPlane_mm = 0.8 * ViewMeter::kLandmarkDistance_mm;  // margin to the limit that counts
  const Pose probe_from_patient = view.patient_from_probe.inverse();
  std::vector<std::string> names;
  for (const Landmark& landmark : subject.landmarks) {
    const auto belongs_to = [&](const std::string& owner) { return landmark.name.starts_with(owner + "_"); };
    if (!belongs_to(view.name) && std::none_of(view.targets.begin(), view.targets.end(), belongs_to)) continue;
    const glm::dvec3 p = probe_from_patient.point(landmark.position);
    if (std::abs(p.z) <= kOnPlane_mm && line_position(probe, view.depth_mm, glm::dvec2(p)))
      names.push_back(landmark.name);
  }
  return names;
}

class Suggestions {
public:
  Suggestions(const Case& subject, const BodyMask& body, const TissueTable& tissues)
      : subject_(subject),
        tissues_(tissues),
        probe_(*find_probe("curvilinear")),
        search_(subject, body, tissues, probe_) {}

  /// Adds the plan that shows most, or the first among equals. The plans are for one view and differ only in their aim.
  void add_best(const std::vector<Plan>& plans) {
    const Plan* chosen = nullptr;
    std::optional<Window> window;
    for (const Plan& plan : plans) {
      const auto found = search_.best(plan.wanted);
      if (!found ||
          (window && found->section_share * found->clear_share <= window->section_share * window->clear_share))
        continue;
      window = found;
      chosen = &plan;
    }
    if (!window) {
      made_.notes.push_back("No view '" + plans.front().name + "': no place on the skin shows it.");
      return;
    }
    const std::string shows = whole_percent(window->section_share) + " of the section, " +
                              whole_percent(window->clear_share) + " of it clear of bone and gas";
    if (window->clear_share < kMinClear || window->section_share < kMinSection) {
      made_.notes.push_back("No view '" + chosen->name + "': the best place on the skin shows " + shows + ".");
      return;
    }
    ReferenceView view;
    view.name = chosen->name;
    view.title = chosen->title;
    view.probe = probe_.name;
    view.depth_mm = std::clamp(std::ceil((window->depth_mm + kBehind_mm) / kDepthStep_mm) * kDepthStep_mm, kMinDepth_mm,
                               kMaxDepth_mm);
    view.targets = chosen->targets;
    view.patient_from_probe = window->patient_from_probe;
    view.landmarks = landmarks_in(subject_, probe_, view);
    const ViewMeter usable(subject_, view, tissues_);  // throws if a scenario could not use the view
    made_.views.push_back(std::move(view));
    made_.notes.push_back("View '" + chosen->name + "' shows " + shows + ".");
  }

  SuggestedViews finish() { return std::move(made_); }

private:
  const Case& subject_;
  const TissueTable& tissues_;
  const Probe& probe_;
  WindowSearch search_;
  SuggestedViews made_;
};

}  // namespace

SuggestedViews suggest_views(const Case& subject, const Anatomy& anatomy, const BodyMask& body,
                             const TissueTable& tissues, const Progress& progress) {
  std::vector<std::vector<Plan>> all;
  for (const StructureShape* organ : anatomy.organs) {
    std::vector<Plan> plans;
    plan_organ(*organ, plans);
    for (Plan& plan : plans) all.push_back({std::move(plan)});
  }
  for (const Vessel& vessel : anatomy.vessels) {
    std::vector<Plan> along;
    for (const VesselLevel& level : vessel.levels) {
      all.push_back({plan_across(vessel, level)});
      along.push_back(plan_along(vessel, level));
    }
    all.push_back(std::move(along));
  }
  for (const Recess& recess : anatomy.recesses) all.push_back({plan_recess(recess)});

  Suggestions suggestions(subject, body, tissues);
  for (std::size_t p = 0; p < all.size(); ++p) {
    suggestions.add_best(all[p]);
    if (progress) progress(double(p + 1) / double(all.size()));
  }
  return suggestions.finish();
}

}  // namespace insonate
