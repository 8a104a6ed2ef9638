#include "scenarios/steps/sweep.h"

#include <algorithm>
#include <cmath>

#include "scenarios/metrics/path_grid.h"
#include "scenarios/metrics/view_meter.h"
#include "scenarios/metrics/visibility.h"
#include "scenarios/steps/structures.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

/// Returns the centres of the organ's cells: voxels at a regular stride along each axis that lie in the organ.
std::vector<glm::dvec3> cells_of(const LabelIndex& index, const std::vector<std::string>& organ) {
  const StructureSet structures(index, organ);
  const Volume<std::uint8_t>& labels = index.subject().labels;
  const Grid& grid = labels.grid;
  const auto stride = [](double spacing) { return std::max(1, int(std::lround(Sweep::kCell_mm / spacing))); };
  const glm::ivec3 step(stride(grid.spacing.x), stride(grid.spacing.y), stride(grid.spacing.z));
  const glm::ivec3 half = step / 2, last = structures.extent().last;
  const glm::ivec3 first = (glm::max(structures.extent().first - half, 0) + step - 1) / step * step + half;
  std::vector<glm::dvec3> cells;
  for (int k = first.z; k <= last.z; k += step.z)
    for (int j = first.y; j <= last.y; j += step.y)
      for (int i = first.x; i <= last.x; i += step.x)
        if (structures.holds(labels.at({i, j, k}))) cells.push_back(grid.patient_from_index({i, j, k}));
  return cells;
}

class SweepRun : public StepRun {
public:
  SweepRun(const Sweep& asked, const StepWorld& world, const std::vector<glm::dvec3>& cells, double now_s)
      : asked_(asked), world_(world), path_(now_s), cells_(cells), total_(cells.size()) {
    for (const std::string& name : asked.keep) landmarks_.push_back(world.subject.find_landmark(name)->position);
  }

  void see(const Moment& moment) override {
    if (!moment.valid || moment.machine.frozen) return;
    const Probe* probe = find_probe(moment.machine.probe);
    if (!visibility_ || visibility_->probe().name != moment.machine.probe ||
        visibility_->depth_mm() != moment.machine.depth_mm)
      visibility_.emplace(world_.subject, *probe, moment.machine.depth_mm, world_.tissues);
    path_.feed(moment.now_s, moment.patient_from_probe, [&](long, const Pose& pose, bool) { look_from(pose); });
  }

  bool done() const override { return coverage_percent() >= asked_.enough_percent; }
  bool on_target() const override { return on_target_; }
  double share_done() const override { return std::min(1.0, coverage_percent() / asked_.enough_percent); }
  /// Without a coverage limit, the learner decides when the organ was swept.
  bool counts_as_done() const override { return asked_.enough_percent >= 100 && coverage_percent() > 0; }

  void finish(StepOutcome, double, StepResult& result) const override {
    result.values.emplace_back(Metric::coverage_percent, coverage_percent());
    if (!landmarks_.empty() && looks_ > 0)
      result.values.emplace_back(Metric::kept_in_view_percent, 100.0 * double(kept_) / double(looks_));
  }

private:
  double coverage_percent() const { return total_ > 0 ? 100.0 * double(total_ - cells_.size()) / double(total_) : 0; }

  void look_from(const Pose& pose) {
    visibility_->look_from(pose);
    const std::size_t before = cells_.size();
    std::erase_if(cells_, [&](const glm::dvec3& cell) { return visibility_->reaches(cell); });
    on_target_ = cells_.size() < before;
    ++looks_;
    const Pose probe_from_patient = pose.inverse();
    kept_ += std::all_of(landmarks_.begin(), landmarks_.end(), [&](const glm::dvec3& landmark) {
      const glm::dvec3 p = probe_from_patient.point(landmark);
      return std::abs(p.z) <= ViewMeter::kLandmarkDistance_mm &&
             line_position(visibility_->probe(), visibility_->depth_mm(), glm::dvec2(p));
    });
  }

  const Sweep& asked_;
  StepWorld world_;
  PathGrid path_;
  std::vector<glm::dvec3> cells_;  ///< not yet covered
  std::size_t total_;
  std::vector<glm::dvec3> landmarks_;
  std::optional<Visibility> visibility_;
  long looks_ = 0;
  long kept_ = 0;
  bool on_target_ = false;  ///< the last pose covered new cells
};

}  // namespace

std::shared_ptr<const StepTask> Sweep::read(const TomlTable& table, const Step&) {
  auto task = std::make_shared<Sweep>();
  task->organ = table.texts("organ", 1, 20);
  if (table.has("keep")) task->keep = table.texts("keep", 1, 20);
  task->enough_percent = table.number("coverage_percent", {1, 100}, 100);
  task->organ_place = table.place("organ");
  task->keep_place = table.place("keep");
  return task;
}

std::vector<Metric> Sweep::metrics() const {
  std::vector<Metric> measured{Metric::coverage_percent};
  if (!keep.empty()) measured.push_back(Metric::kept_in_view_percent);
  return measured;
}

void Sweep::check(const Step&, const LabelIndex& labels, const std::string& where,
                  std::vector<Mistake>& problems) const {
  const Case& subject = labels.subject();
  const std::size_t before = problems.size();
  check_structures(organ, organ_place, subject, where, problems);
  if (problems.size() == before && cells_of(labels, organ).empty())
    problems.push_back({organ_place, where + " sweeps an organ that this patient does not have", "name another"});
  const std::vector<std::string> known = names_of(subject.landmarks);
  for (const std::string& name : keep)
    if (!subject.find_landmark(name))
      problems.push_back(
          {keep_place,
           where + " names the landmark '" + name + "', which the case '" + subject.name + "' does not have",
           known.empty() ? "take a case with landmarks" : suggest(name, known)});
}

StepBegin Sweep::prepare(const StepWorld& world) const {
  return [this, world, cells = cells_of(world.labels, organ)](double now_s) {
    return std::make_unique<SweepRun>(*this, world, cells, now_s);
  };
}

}  // namespace insonate
