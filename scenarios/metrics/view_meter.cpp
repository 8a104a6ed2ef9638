#include "scenarios/metrics/view_meter.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

double angle_between_normals_deg(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

std::vector<double> cell_areas(const ScanLines& set) {
  const int count = int(set.lines.size());
  std::vector<double> areas(std::size_t(count) * std::size_t(set.samples));
  for (int k = 0; k < set.samples; ++k) {
    const double r = set.r_min_mm + (k + 0.5) * set.dr_mm();
    const auto point = [&](int i) { return set.lines[std::size_t(i)].start + set.lines[std::size_t(i)].direction * r; };
    for (int i = 0; i < count; ++i) {
      // Half the distance to each neighbour. The outer lines extend outwards as far as inwards.
      const double left = glm::distance(point(std::max(i - 1, 0)), point(std::max(i, 1)));
      const double right = glm::distance(point(std::min(i, count - 2)), point(std::min(i + 1, count - 1)));
      areas[std::size_t(i) * std::size_t(set.samples) + std::size_t(k)] = set.dr_mm() * (left + right) / 2;
    }
  }
  return areas;
}

Probe probe_of(const Case& subject, const ReferenceView& view, int lines) {
  if (const Probe* probe = find_probe(view.probe)) {
    Probe coarse = *probe;
    coarse.lines = lines;
    return coarse;
  }
  throw InputError(subject.name, "view '" + view.name + "'", "its probe '" + view.probe + "' does not exist",
                   suggest(view.probe, probe_names()));
}

}  // namespace

std::span<const ViewValues::Field> ViewValues::fields() {
  static constexpr std::array kFields{
      Field{Metric::plane_distance_mm, &ViewValues::plane_distance_mm},
      Field{Metric::in_plane_offset_mm, &ViewValues::in_plane_offset_mm},
      Field{Metric::plane_angle_deg, &ViewValues::plane_angle_deg},
      Field{Metric::tilt_deg, &ViewValues::tilt_deg},
      Field{Metric::rock_deg, &ViewValues::rock_deg},
      Field{Metric::rotation_deg, &ViewValues::rotation_deg},
      Field{Metric::off_centre_percent, &ViewValues::off_centre_percent},
      Field{Metric::target_in_view_percent, &ViewValues::target_in_view_percent},
      Field{Metric::target_insonated_percent, &ViewValues::target_insonated_percent},
      Field{Metric::landmarks_in_view_percent, &ViewValues::landmarks_in_view_percent},
      Field{Metric::depth_use_percent, &ViewValues::depth_use_percent},
  };
  return kFields;
}

double ViewValues::of(Metric picture_metric) const {
  for (const auto& [metric, value] : fields())
    if (metric == picture_metric) return std::abs(this->*value);
  return 0;  // not a picture metric
}

ViewMeter::ViewMeter(const Case& subject, const ReferenceView& view, const TissueTable& tissues, int lines)
    : case_(&subject),
      view_(&view),
      probe_(probe_of(subject, view, lines)),
      lines_(scan_lines(probe_, view.depth_mm, int(std::ceil(view.depth_mm / kSampleDistance_mm)))),
      transmission_(subject.ct, tissues, lines_.dr_mm(), probe_.frequency_mhz),
      cell_mm2_(cell_areas(lines_)) {
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw InputError(subject.name, "view '" + view.name + "'", problem, remedy);
  };
  for (const std::string& name : view.targets) {
    const Label* label = subject.find_label(name);
    if (!label) refuse("its target '" + name + "' is not a label of the case", "name one that is");
    is_target_.set(label->value);
  }
  for (const std::string& name : view.landmarks) {
    const Landmark* landmark = subject.find_landmark(name);
    if (!landmark) refuse("its landmark '" + name + "' is not in the case", "name one that is");
    landmarks_.push_back(landmark->position);
  }
  reference_ = target_area(view.patient_from_probe, 0);
  if (is_target_.any() && !subject.labels.empty()) {
    if (reference_.seen_mm2 == 0) refuse("its targets do not appear in its picture", "correct its pose or its targets");
    least_transmission_ = kArrives * reference_.transmission_mm2 / reference_.seen_mm2;
    reference_ = target_area(view.patient_from_probe, least_transmission_);
  }
  target_point_ = find_target_point(reference_);
  target_in_reference_ = glm::dvec2(view.patient_from_probe.inverse().point(target_point_));
}

glm::dvec3 ViewMeter::find_target_point(const TargetArea& reference) const {
  if (!landmarks_.empty()) {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& landmark : landmarks_) sum += landmark;
    return sum / double(landmarks_.size());
  }
  glm::dvec2 in_plane(0, view_->depth_mm / 2);
  if (reference.seen_mm2 > 0) in_plane = reference.moment_mm3 / reference.seen_mm2;
  return view_->patient_from_probe.point(glm::dvec3(in_plane, 0));
}

ViewMeter::TargetArea ViewMeter::target_area(const Pose& patient_from_probe, double least_transmission) const {
  TargetArea area;
  if (is_target_.none() || case_->labels.empty()) return area;
  const int count = int(lines_.lines.size());
  std::vector<double> intensity(std::size_t(lines_.samples));
  std::vector<int> in_targets;
  for (int i = 0; i < count; ++i) {
    // Labels lie on the CT's grid, so one voxel line serves both.
    const VoxelLine way = voxel_line(case_->ct.grid, lines_, std::size_t(i), patient_from_probe);
    in_targets.clear();
    for (int k = 0; k < lines_.samples; ++k)
      if (is_target_[sample_nearest(case_->labels, way.at(k + 0.5))]) in_targets.push_back(k);
    if (in_targets.empty()) continue;
    // Transmission behind the last target sample is not needed.
    transmission_.along(way, std::span(intensity).first(std::size_t(in_targets.back()) + 1));
    const ScanLine& line = lines_.lines[std::size_t(i)];
    const double across = (2 * i + 1 - count) / double(count);
    for (const int k : in_targets) {
      const double r_mm = lines_.r_min_mm + (k + 0.5) * lines_.dr_mm();
      const double cell = cell_mm2_[std::size_t(i) * std::size_t(lines_.samples) + std::size_t(k)];
      if (area.seen_mm2 == 0) area.nearest_mm = r_mm;
      area.nearest_mm = std::min(area.nearest_mm, r_mm);
      area.furthest_mm = std::max(area.furthest_mm, r_mm);
      area.seen_mm2 += cell;
      area.transmission_mm2 += cell * intensity[std::size_t(k)];
      if (intensity[std::size_t(k)] >= least_transmission) area.insonated_mm2 += cell;
      area.off_centre_mm2 += cell * across;
      area.moment_mm3 += cell * glm::dvec2(line.start + line.direction * r_mm);
    }
  }
  return area;
}

double ViewMeter::landmarks_in_view_percent(const Pose& probe_from_patient) const {
  if (landmarks_.empty()) return 0;
  int seen = 0;
  for (const glm::dvec3& landmark : landmarks_) {
    const glm::dvec3 p = probe_from_patient.point(landmark);
    seen += std::abs(p.z) <= kLandmarkDistance_mm && line_position(probe_, view_->depth_mm, glm::dvec2(p));
  }
  return 100.0 * seen / double(landmarks_.size());
}

ViewValues ViewMeter::measure(const Pose& patient_from_probe, double depth_mm) const {
  ViewValues values;
  const Pose probe_from_patient = patient_from_probe.inverse();
  const glm::dvec3 target = probe_from_patient.point(target_point_);
  values.plane_distance_mm = target.z;
  values.in_plane_offset_mm = glm::distance(glm::dvec2(target), target_in_reference_);

  const glm::dmat3 turn = glm::transpose(view_->patient_from_probe.rotation) * patient_from_probe.rotation;
  values.plane_angle_deg = angle_between_normals_deg({0, 0, 1}, turn[2]);
  const glm::dvec3& beam = turn[1];  // (-sin rock, cos rock cos tilt, cos rock sin tilt)
  const double tilt = std::atan2(beam.z, beam.y);
  const double rock = std::atan2(-beam.x, std::hypot(beam.y, beam.z));
  // The lateral and elevation axes without rotation. The probe's lateral axis lies in their plane.
  const glm::dvec3 lateral(std::cos(rock), std::sin(rock) * std::cos(tilt), std::sin(rock) * std::sin(tilt));
  const glm::dvec3 elevation(0, -std::sin(tilt), std::cos(tilt));
  values.tilt_deg = glm::degrees(tilt);
  values.rock_deg = glm::degrees(rock);
  values.rotation_deg = glm::degrees(std::atan2(-glm::dot(turn[0], elevation), glm::dot(turn[0], lateral)));

  values.landmarks_in_view_percent = landmarks_in_view_percent(probe_from_patient);
  const TargetArea area = target_area(patient_from_probe, least_transmission_);
  if (area.seen_mm2 > 0) {
    values.target_in_view_percent = 100 * area.seen_mm2 / reference_.seen_mm2;
    values.off_centre_percent = 100 * std::abs(area.off_centre_mm2 / area.seen_mm2);
    values.depth_use_percent =
        100 * (std::min(area.furthest_mm, depth_mm) - std::min(area.nearest_mm, depth_mm)) / depth_mm;
    if (reference_.insonated_mm2 > 0)
      values.target_insonated_percent = 100 * area.insonated_mm2 / reference_.insonated_mm2;
  }
  return values;
}

}  // namespace insonate
