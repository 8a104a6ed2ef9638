#include "scenarios/steps/measure.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>

#include "scenarios/caliper.h"
#include "scenarios/metrics/view_meter.h"
#include "scenarios/steps/plane_region.h"
#include "scenarios/steps/structures.h"
#include "scenarios/words.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

constexpr double kWindow_mm = 100;  // to each side of the search point: larger than any organ

const ReferenceView* view_of(const MeasureTarget& target, const Step& step, const Case& subject) {
  return subject.find_view(target.view.empty() ? step.view : target.view);
}

/// Returns the target's part in its view's plane, or nothing if the structures do not intersect it.
std::optional<PlaneRegion> region_of(const MeasureTarget& target, const Step& step, const LabelIndex& labels) {
  const Case& subject = labels.subject();
  const ReferenceView& view = *view_of(target, step, subject);
  std::optional<glm::dvec2> near;
  if (const Landmark* landmark = subject.find_landmark(target.through))
    near = glm::dvec2(view.patient_from_probe.inverse().point(landmark->position));
  return plane_region(StructureSet(labels, target.structures), view.patient_from_probe, near, kWindow_mm,
                      Measure::kPitch_mm);
}

double extent_of(const PlaneRegion& region, MeasureTarget::Along along) {
  switch (along) {
    case MeasureTarget::Along::depth:
      return region.extent_mm({0, 1});
    case MeasureTarget::Along::lateral:
      return region.extent_mm({1, 0});
    case MeasureTarget::Along::longest:
      break;
  }
  return region.longest_extent_mm();
}

/// The true value, and the position of the (first) target's middle in the patient.
struct Truth {
  std::optional<double> value;  ///< mm, mm2, a ratio or ml, by tool
  std::optional<glm::dvec3> middle;
};

Truth truth_of(const Measure& asked, const Step& step, const LabelIndex& labels) {
  Truth truth;
  if (asked.tool == Measure::Tool::volume) {
    const double volume_mm3 = StructureSet(labels, asked.targets[0].structures).volume_mm3();
    if (volume_mm3 > 0) truth.value = volume_mm3 / 1000;
    return truth;
  }
  std::vector<PlaneRegion> regions;
  for (const MeasureTarget& target : asked.targets) {
    auto region = region_of(target, step, labels);
    if (!region) return truth;
    regions.push_back(std::move(*region));
  }
  const ReferenceView& view = *view_of(asked.targets[0], step, labels.subject());
  truth.middle = view.patient_from_probe.point(glm::dvec3(regions[0].middle(), 0));
  if (asked.tool == Measure::Tool::ellipse) {
    truth.value = regions[0].area_mm2();
  } else {
    truth.value = extent_of(regions[0], asked.targets[0].along);
    if (asked.tool == Measure::Tool::ratio) *truth.value /= extent_of(regions[1], asked.targets[1].along);
  }
  return truth;
}

class MeasureRun : public StepRun {
public:
  MeasureRun(const Measure& asked, const ViewMeter* meter, const Truth& truth)
      : asked_(asked), meter_(meter), truth_(truth) {}

  void act(const Action& action, const Moment& moment) override {
    const bool has_slot = action.slot() >= 1 && action.slot() <= asked_.slots();
    if (action.kind == ActionKind::take_back && has_slot) placed_[std::size_t(action.slot() - 1)].reset();
    if (action.kind != asked_.places() || !moment.machine.frozen_at || !has_slot) return;
    placed_[std::size_t(action.slot() - 1)] =
        Placed{action, *moment.machine.frozen_at, moment.now_s, moment.machine.depth_mm, ++order_};
  }
  bool counts_as_done() const override { return count() == asked_.slots(); }
  double share_done() const override { return double(count()) / asked_.slots(); }
  std::string why_no_value() const override {
    if (count() == 0) return "nothing was measured in a frozen picture.";
    return "only " + std::to_string(count()) + " of " + std::to_string(asked_.slots()) + " lengths were measured.";
  }

  void finish(StepOutcome, double, StepResult& result) const override {
    const Placed* last = last_placed();
    if (last && meter_) {
      result.judged = meter_->measure(last->patient_from_probe, last->depth_mm);
      result.judged_from_s = result.judged_to_s = last->time_s;
    }
    if (last && asked_.slots() > 1) result.facts.emplace_back(StepResult::kLengths, lengths());
    if (!counts_as_done()) return;
    std::vector<Action> placed;
    for (int i = 0; i < asked_.slots(); ++i) placed.push_back(placed_[std::size_t(i)]->action);
    const double measured = asked_.value(placed);
    result.facts.emplace_back(StepResult::kMeasured, with_unit(measured));
    if (!truth_.value) return;
    result.facts.emplace_back("truth", with_unit(*truth_.value) + ", " + asked_.walls);
    if (asked_.tool == Measure::Tool::distance)
      result.values.emplace_back(Metric::measurement_error_mm, std::abs(measured - *truth_.value));
    result.values.emplace_back(Metric::measurement_error_percent,
                               100 * std::abs(measured - *truth_.value) / *truth_.value);
    if (truth_.middle)
      result.values.emplace_back(Metric::measurement_offset_mm, glm::distance(middle_of(*placed_[0]), *truth_.middle));
  }

private:
  struct Placed {
    Action action;
    Pose patient_from_probe;  ///< of the frozen picture
    double time_s;
    double depth_mm;
    int order;
  };

  int count() const {
    return int(std::count_if(placed_.begin(), placed_.end(), [](const auto& p) { return p.has_value(); }));
  }
  /// Returns the last placed item; its picture is judged.
  const Placed* last_placed() const {
    const Placed* last = nullptr;
    for (const auto& placed : placed_)
      if (placed && (!last || placed->order > last->order)) last = &*placed;
    return last;
  }
  /// Returns the length of each slot that has one, in their order.
  std::string lengths() const {
    std::string lengths;
    for (const auto& placed : placed_)
      if (placed) lengths += (lengths.empty() ? "" : ", ") + fixed(caliper_length_mm(placed->action), 1) + " mm";
    return lengths;
  }
  std::string with_unit(double value) const {
    // A distance uses the same unit for the measured and the true value, whatever their size.
    return asked_.tool == Measure::Tool::distance ? fixed(value, 1) + " mm" : asked_.value_text(value);
  }
  static glm::dvec3 middle_of(const Placed& placed) {
    return placed.patient_from_probe.point(glm::dvec3((placed.action.point(1) + placed.action.point(3)) / 2.0, 0));
  }

  const Measure& asked_;
  const ViewMeter* meter_;  ///< of the step's view; nullptr if the step names none
  Truth truth_;
  std::array<std::optional<Placed>, 3> placed_;
  int order_ = 0;
};

MeasureTarget read_target(const TomlTable& table, const Step& step, Measure::Tool tool) {
  MeasureTarget target;
  target.structures = table.texts("structures", 1, 20);
  target.place = table.place("structures");
  if (tool == Measure::Tool::volume) return target;
  target.view = step.view.empty() ? table.text("view") : table.text("view", "");
  if (table.has("view")) target.place = table.place("view");
  target.through = table.text("through", "");
  if (tool == Measure::Tool::ellipse) return target;
  target.along = MeasureTarget::Along(
      table.choice("along", {"depth", "lateral", "longest"}, std::size_t(MeasureTarget::Along::longest)));
  return target;
}

}  // namespace

int Measure::slots() const {
  return tool == Tool::volume ? 3 : tool == Tool::ratio ? 2 : 1;
}

double Measure::value(const std::vector<Action>& placed) const {
  const auto length = [&](std::size_t slot) { return caliper_length_mm(placed[slot]); };
  switch (tool) {
    case Tool::distance:
      break;
    case Tool::ellipse:
      return ellipse_area_mm2(placed[0]);
    case Tool::ratio:
      return length(1) > 0 ? length(0) / length(1) : 0;
    case Tool::volume:
      return ellipsoid_volume_ml(length(0), length(1), length(2));
  }
  return length(0);
}

std::string Measure::value_text(double value) const {
  switch (tool) {
    case Tool::distance:
      break;
    case Tool::ellipse:
      return area_text(value);
    case Tool::ratio:
      return fixed(value, 2);
    case Tool::volume:
      return volume_text(value);
  }
  return length_text(value);
}

StepInput Measure::input() const {
  MeasureInput input{places(), {}, walls, "", {}};
  if (slots() == 1) {
    input.slots = {tool == Tool::ellipse ? "Area" : "Distance"};
    return input;
  }
  input.result = tool == Tool::ratio ? "Ratio" : "Volume";
  input.result_text = [this](const std::vector<Action>& placed) { return value_text(value(placed)); };
  static constexpr std::array kAlong{", depth", ", width", ""}, kOfVolume{"Length", "Depth", "Width"};
  for (int slot = 0; slot < slots(); ++slot) {
    if (tool == Tool::volume) {
      input.slots.emplace_back(kOfVolume[std::size_t(slot)]);
    } else {
      const MeasureTarget& target = targets[std::size_t(slot)];
      input.slots.push_back(in_words(target.structures.front()) + kAlong[std::size_t(target.along)]);
    }
  }
  return input;
}

std::shared_ptr<const StepTask> Measure::read(const TomlTable& table, const Step& step) {
  auto task = std::make_shared<Measure>();
  task->tool = Tool(table.choice("tool", {"distance", "ellipse", "ratio", "volume"}));
  task->walls = table.text("walls");
  const std::size_t wanted = task->tool == Tool::ratio ? 2 : 1;
  for (const TomlTable& target : table.tables("target", wanted))
    task->targets.push_back(read_target(target, step, task->tool));
  if (task->targets.size() < wanted)
    table.report("", "there are too few targets for the tool",
                 "add " + std::string(wanted == 2 ? "two" : "a") + " [[step.target]]");
  return task;
}

std::vector<Metric> Measure::metrics() const {
  std::vector<Metric> measured{Metric::measurement_error_percent};
  if (tool == Tool::distance) measured.push_back(Metric::measurement_error_mm);
  if (tool != Tool::volume) measured.push_back(Metric::measurement_offset_mm);
  return measured;
}

void Measure::check(const Step& step, const LabelIndex& labels, const std::string& where,
                    std::vector<Mistake>& problems) const {
  const Case& subject = labels.subject();
  const std::size_t before = problems.size();
  for (const MeasureTarget& target : targets) {
    check_structures(target.structures, target.place, subject, where, problems);
    if (tool == Tool::volume) continue;
    const std::vector<std::string> views = names_of(subject.views), landmarks = names_of(subject.landmarks);
    if (!view_of(target, step, subject))
      problems.push_back({target.place, where + " measures in the view '" + target.view + "', which is not there",
                          views.empty() ? "take a case with views" : suggest(target.view, views)});
    if (!target.through.empty() && !subject.find_landmark(target.through))
      problems.push_back({target.place,
                          where + " measures at the landmark '" + target.through + "', which is not there",
                          landmarks.empty() ? "take a case with landmarks" : suggest(target.through, landmarks)});
  }
  if (problems.size() == before && !truth_of(*this, step, labels).value)
    problems.push_back({targets[0].place, where + " measures what this patient does not have there",
                        "name structures that cross the view's picture"});
}

StepBegin Measure::prepare(const StepWorld& world) const {
  return [this, meter = world.meter, truth = truth_of(*this, world.step, world.labels)](double) {
    return std::make_unique<MeasureRun>(*this, meter, truth);
  };
}

}  // namespace insonate
