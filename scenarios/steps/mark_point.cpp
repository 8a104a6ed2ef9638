#include "scenarios/steps/mark_point.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

#include "scenarios/steps/structures.h"
#include "scenarios/words.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

/// Returns the patient position of an action's point: in the frozen picture, or else in that of the last valid sample.
std::optional<glm::dvec3> place_in_patient(const Action& action, const Moment& moment) {
  const glm::dvec3 in_plane(action.point(0), 0);
  if (moment.machine.frozen_at) return moment.machine.frozen_at->point(in_plane);
  if (!moment.valid) return std::nullopt;
  return moment.patient_from_probe.point(in_plane);
}

class PointRun : public StepRun {
public:
  PointRun(const Landmark* landmark, const StructureSurface& structures)
      : landmark_(landmark), structures_(structures) {}

  void act(const Action& action, const Moment& moment) override {
    if (action.kind == ActionKind::take_back && action.slot() == 0 && action.text.empty()) point_.reset();
    if (action.kind != ActionKind::point) return;
    if (const auto place = place_in_patient(action, moment)) point_ = place;
  }
  bool counts_as_done() const override { return point_.has_value(); }
  double share_done() const override { return point_ ? 1 : 0; }
  std::string why_no_value() const override { return "nothing was pointed at."; }

  void finish(StepOutcome, double, StepResult& result) const override {
    if (!point_) return;
    const auto error =
        landmark_ ? std::optional(glm::distance(*point_, landmark_->position)) : structures_.distance_mm(*point_);
    if (error) result.values.emplace_back(Metric::point_error_mm, *error);
  }

private:
  const Landmark* landmark_;  ///< nullptr if structures are the target
  const StructureSurface& structures_;
  std::optional<glm::dvec3> point_;
};

using Surfaces = std::map<std::string, StructureSurface>;

class LabelRun : public StepRun {
public:
  LabelRun(const LabelStructures& asked, const Surfaces& structures) : asked_(asked), structures_(structures) {}

  void act(const Action& action, const Moment& moment) override {
    if (action.kind == ActionKind::take_back && action.slot() == 0) places_.erase(action.text);
    if (action.kind != ActionKind::label) return;
    if (!structures_.contains(action.text)) return;
    if (const auto place = place_in_patient(action, moment)) places_[action.text] = *place;
  }
  bool counts_as_done() const override { return places_.size() == asked_.structures.size(); }
  double share_done() const override { return double(places_.size()) / double(asked_.structures.size()); }

  void finish(StepOutcome, double, StepResult& result) const override {
    int right = 0;
    for (const auto& [name, place] : places_) {
      const auto off = structures_.at(name).distance_mm(place);
      const bool hit = off && *off <= asked_.tolerance_mm;
      right += hit;
      result.facts.emplace_back(name, hit ? "right" : off ? fixed(*off, 1) + " mm off" : "not in this patient");
    }
    result.values.emplace_back(Metric::labels_right_percent, 100.0 * right / double(asked_.structures.size()));
  }

private:
  const LabelStructures& asked_;
  const Surfaces& structures_;
  std::map<std::string, glm::dvec3> places_;
};

}  // namespace

std::shared_ptr<const StepTask> MarkPoint::read(const TomlTable& table, const Step&) {
  auto task = std::make_shared<MarkPoint>();
  if (table.has("landmark") == table.has("structures"))
    table.report("", table.has("landmark") ? "both a landmark and structures are named" : "nothing to mark is named",
                 "give either landmark = \"...\" or structures = [\"...\"]");
  task->landmark = table.text("landmark", "");
  if (table.has("structures")) task->structures = table.texts("structures", 1, 20);
  task->place = table.place(table.has("landmark") ? "landmark" : "structures");
  return task;
}

void MarkPoint::check(const Step&, const LabelIndex& labels, const std::string& where,
                      std::vector<Mistake>& problems) const {
  const Case& subject = labels.subject();
  check_structures(structures, place, subject, where, problems);
  if (landmark.empty() || subject.find_landmark(landmark)) return;
  const std::vector<std::string> known = names_of(subject.landmarks);
  problems.push_back(
      {place, where + " names the landmark '" + landmark + "', which the case '" + subject.name + "' does not have",
       known.empty() ? "take a case with landmarks" : suggest(landmark, known)});
}

StepBegin MarkPoint::prepare(const StepWorld& world) const {
  return [landmark = world.subject.find_landmark(landmark), surface = StructureSurface(world.labels, structures)](
             double) { return std::make_unique<PointRun>(landmark, surface); };
}

std::shared_ptr<const StepTask> LabelStructures::read(const TomlTable& table, const Step&) {
  auto task = std::make_shared<LabelStructures>();
  task->structures = table.texts("structures", 1, 20);
  std::vector<std::string> sorted = task->structures;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    table.report("structures", "a structure is named twice", "name each once");
  task->tolerance_mm = table.number("tolerance_mm", {0, 20}, 2);
  task->place = table.place("structures");
  return task;
}

void LabelStructures::check(const Step&, const LabelIndex& labels, const std::string& where,
                            std::vector<Mistake>& problems) const {
  check_structures(structures, place, labels.subject(), where, problems);
}

StepBegin LabelStructures::prepare(const StepWorld& world) const {
  Surfaces surfaces;
  for (const std::string& name : structures) surfaces.emplace(name, StructureSurface(world.labels, {name}));
  return [this, surfaces = std::move(surfaces)](double) { return std::make_unique<LabelRun>(*this, surfaces); };
}

}  // namespace insonate
