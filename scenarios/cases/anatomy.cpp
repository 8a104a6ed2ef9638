#include "scenarios/cases/anatomy.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cctype>

namespace insonate {
namespace {

constexpr std::array kOrgans = {"liver",       "spleen",   "kidney_right",    "kidney_left",
                                "gallbladder", "pancreas", "urinary_bladder", "prostate"};
constexpr std::array kVessels = {"aorta", "inferior_vena_cava"};
constexpr std::size_t kFewestVoxels = 1000;  // 1 ml at 1 mm: a sliver at the CT's edge has no axes
constexpr double kSectionHalf_mm = 4;        // a vessel's centre is averaged over this distance up and down
constexpr double kCourse_mm = 15;            // and its direction is taken between the centres at this distance
constexpr double kRecess_mm = 20;            // organs further apart have fat between them, not a recess

/// Returns the shape of the structure with that name, or null if it is missing or a sliver.
const StructureShape* find_whole(const std::vector<StructureShape>& shapes, std::string_view name) {
  const StructureShape* found = find_shape(shapes, name);
  return found && found->voxels >= kFewestVoxels ? found : nullptr;
}

/// The range of heights of a structure's bounding box.
struct Heights {
  double bottom = 1e9, top = -1e9;
};

Heights heights_of(const Case& subject, const StructureShape& shape) {
  Heights heights;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 index(corner & 1 ? shape.high.x : shape.low.x, corner & 2 ? shape.high.y : shape.low.y,
                           corner & 4 ? shape.high.z : shape.low.z);
    const double z = subject.labels.grid.patient_from_index(index).z;
    heights = {std::min(heights.bottom, z), std::max(heights.top, z)};
  }
  return heights;
}

std::optional<VesselLevel> level_at(const Case& subject, const StructureShape& vessel, double z) {
  const auto here = centre_at_height(subject, vessel, z, kSectionHalf_mm);
  const auto below = centre_at_height(subject, vessel, z - kCourse_mm, kSectionHalf_mm);
  const auto above = centre_at_height(subject, vessel, z + kCourse_mm, kSectionHalf_mm);
  if (!here || !below || !above) return std::nullopt;
  return VesselLevel{"", "", "", *here, glm::normalize(*above - *below)};
}

Vessel follow(const Case& subject, const StructureShape& shape, const std::vector<StructureShape>& shapes) {
  auto [bottom, top] = heights_of(subject, shape);
  // Above the liver's dome lies the chest, where the aorta is behind the lung.
  if (const StructureShape* liver = find_whole(shapes, "liver")) top = std::min(top, heights_of(subject, *liver).top);
  Vessel vessel{&shape, {}};
  const auto add = [&](double z, const std::string& name, const std::string& title) {
    if (auto level = level_at(subject, shape, z)) {
      level->landmark = shape.label.name + "_" + name;
      level->name = name;
      level->title = title;
      vessel.levels.push_back(*level);
    }
  };
  for (const char* name : {"l5", "l4", "l3", "l2", "l1", "t12", "t11"}) {
    const StructureShape* vertebra = find_whole(shapes, std::string("vertebrae_") + name);
    if (!vertebra || vertebra->cut || vertebra->centroid.z <= bottom || vertebra->centroid.z >= top) continue;
    std::string title = std::string("at ") + name;
    title[3] = char(std::toupper(static_cast<unsigned char>(title[3])));
    add(vertebra->centroid.z, name, title);
  }
  if (vessel.levels.empty()) {
    add(bottom + 0.25 * (top - bottom), "lower", "in its lower part");
    add(bottom + 0.5 * (top - bottom), "middle", "in its middle");
    add(bottom + 0.75 * (top - bottom), "upper", "in its upper part");
  }
  return vessel;
}

/// Kidneys and spleen have an upper and a lower pole in any orientation. The ends of other organs are named by
/// direction.
std::string end_of_organ(const StructureShape& organ, bool higher, const glm::dvec3& axis) {
  if (organ.label.name.starts_with("kidney_") || organ.label.name == "spleen") return higher ? "upper" : "lower";
  return end_of_axis(axis);
}

}  // namespace

Anatomy find_anatomy(const Case& subject, const std::vector<StructureShape>& shapes) {
  Anatomy anatomy;
  for (const char* name : kOrgans)
    if (const StructureShape* organ = find_whole(shapes, name)) anatomy.organs.push_back(organ);
  for (const char* name : kVessels)
    if (const StructureShape* shape = find_whole(shapes, name)) {
      Vessel vessel = follow(subject, *shape, shapes);
      if (!vessel.levels.empty()) anatomy.vessels.push_back(std::move(vessel));
    }
  constexpr std::array<std::array<const char*, 3>, 2> kRecesses = {
      {{"hepatorenal", "liver", "kidney_right"}, {"splenorenal", "spleen", "kidney_left"}}};
  for (const auto& [name, organ_name, kidney_name] : kRecesses) {
    const StructureShape *organ = find_whole(shapes, organ_name), *kidney = find_whole(shapes, kidney_name);
    if (!organ || !kidney) continue;
    if (const auto contact = contact_between(subject, *organ, *kidney, kRecess_mm))
      anatomy.recesses.push_back({name, organ, kidney, contact->point});
  }
  return anatomy;
}

std::string first_pole_name(const StructureShape& organ) {
  return organ.label.name + "_" + end_of_organ(organ, organ.first_pole.z >= organ.second_pole.z, organ.axes[0]) +
         "_pole";
}

std::string second_pole_name(const StructureShape& organ) {
  return organ.label.name + "_" + end_of_organ(organ, organ.first_pole.z < organ.second_pole.z, -organ.axes[0]) +
         "_pole";
}

std::vector<Landmark> landmarks_of(const Anatomy& anatomy) {
  std::vector<Landmark> landmarks;
  for (const StructureShape* organ : anatomy.organs) {
    landmarks.push_back({organ->label.name + "_centre", organ->centre});
    landmarks.push_back({first_pole_name(*organ), organ->first_pole});
    landmarks.push_back({second_pole_name(*organ), organ->second_pole});
  }
  for (const Vessel& vessel : anatomy.vessels)
    for (const VesselLevel& level : vessel.levels) landmarks.push_back({level.landmark, level.point});
  for (const Recess& recess : anatomy.recesses) landmarks.push_back({recess.name + "_recess", recess.point});
  return landmarks;
}

}  // namespace insonate
