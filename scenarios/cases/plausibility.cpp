#include "scenarios/cases/plausibility.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

/// Counts the comparisons that were possible and lists those that contradict anatomy.
struct Tally {
  int made = 0;
  std::vector<std::string> against;

  void compare(bool as_it_should, const std::string& otherwise) {
    ++made;
    if (!as_it_should) against.push_back(otherwise);
  }
  void operator+=(const Tally& other) {
    made += other.made;
    against.insert(against.end(), other.against.begin(), other.against.end());
  }
  bool mostly_against() const { return 2 * int(against.size()) > made; }
};

Tally compare_sides(const std::vector<StructureShape>& shapes) {
  Tally tally;
  for (const StructureShape& right : shapes) {
    std::string name = right.label.name;
    const auto at = name.find("_right");
    if (at == std::string::npos) continue;
    const StructureShape* left = find_shape(shapes, name.replace(at, 6, "_left"));
    if (left && left->label.tissue == right.label.tissue)
      tally.compare(right.centroid.x < left->centroid.x,
                    "'" + right.label.name + "' lies left of '" + left->label.name + "'");
  }
  return tally;
}

Tally compare_heights(const std::vector<StructureShape>& shapes) {
  static const std::array kFromBelow = {
      "sacrum",        "vertebrae_l5",  "vertebrae_l4", "vertebrae_l3", "vertebrae_l2", "vertebrae_l1", "vertebrae_t12",
      "vertebrae_t11", "vertebrae_t10", "vertebrae_t9", "vertebrae_t8", "vertebrae_t7", "vertebrae_t6"};
  Tally tally;
  const StructureShape* below = nullptr;
  for (const char* name : kFromBelow) {
    const StructureShape* here = find_shape(shapes, name);
    if (here && below)
      tally.compare(here->centroid.z > below->centroid.z,
                    "'" + here->label.name + "' lies below '" + below->label.name + "'");
    if (here) below = here;
  }
  return tally;
}

Tally compare_depths(const std::vector<StructureShape>& shapes) {
  static const std::array kBeforeTheSpine = {"liver", "stomach", "pancreas", "aorta", "heart", "urinary_bladder"};
  Tally tally;
  double spine = 0;
  int vertebrae = 0;
  for (const StructureShape& shape : shapes)
    if (shape.label.name.starts_with("vertebrae_")) {
      spine += shape.centroid.y;
      ++vertebrae;
    }
  if (vertebrae == 0) return tally;
  for (const char* name : kBeforeTheSpine)
    if (const StructureShape* organ = find_shape(shapes, name))
      tally.compare(organ->centroid.y < spine / vertebrae, "'" + organ->label.name + "' lies behind the spine");
  return tally;
}

/// Plausible range of a structure's median density, HU. It is far wider than in any patient, because only gross errors
/// count.
struct DensityRange {
  std::string_view tissue;
  int least, most;
};
constexpr std::array kDensities = {DensityRange{"lung", -1024, -300}, DensityRange{"liver", -60, 300},
                                   DensityRange{"spleen", -20, 400},  DensityRange{"kidney_cortex", -20, 500},
                                   DensityRange{"muscle", -60, 500},  DensityRange{"bone", 60, 3000}};
constexpr std::size_t kTooSmall = 100;  // voxels: only the edge of a structure

/// Bones have their own tally. If labels are in the wrong place, most bones fail, but soft tissue lies next to equally
/// soft tissue. (In the upper abdomen of the test data, shifted by 20 mm along the body, 7 of 10 bones fail, and none
/// of 9 other structures.) One or two bones, which a tumour may have softened, are judged with the rest.
struct Densities {
  Tally bones, others;
};
constexpr int kFewBones = 2;

Densities compare_densities(const Case& subject, const std::vector<StructureShape>& shapes) {
  Densities tallies;
  for (const StructureShape& shape : shapes) {
    const auto range = std::find_if(kDensities.begin(), kDensities.end(),
                                    [&](const auto& r) { return r.tissue == shape.label.tissue; });
    if (range == kDensities.end() || shape.voxels < kTooSmall) continue;
    std::vector<std::int16_t> densities;
    densities.reserve(shape.voxels);
    for (int k = shape.low.z; k <= shape.high.z; ++k)
      for (int j = shape.low.y; j <= shape.high.y; ++j)
        for (int i = shape.low.x; i <= shape.high.x; ++i)
          if (subject.labels.at({i, j, k}) == shape.label.value) densities.push_back(subject.ct.at({i, j, k}));
    const auto middle = densities.begin() + std::ptrdiff_t(densities.size() / 2);
    std::nth_element(densities.begin(), middle, densities.end());
    Tally& tally = range->tissue == "bone" ? tallies.bones : tallies.others;
    tally.compare(*middle >= range->least && *middle <= range->most,
                  "'" + shape.label.name + "' has a median of " + std::to_string(*middle) + " HU");
  }
  if (tallies.bones.made <= kFewBones) tallies.others += std::exchange(tallies.bones, {});
  return tallies;
}

}  // namespace

std::vector<std::string> check_plausible(const std::string& file, const Case& subject,
                                         const std::vector<StructureShape>& shapes) {
  struct Check {
    Tally tally;
    const char* conclusion;
    const char* remedy;
  };
  const Densities densities = compare_densities(subject, shapes);
  const Check checks[] = {
      {densities.bones, "the labels do not lie on their bones",
       "give the labels of this CT, with the orientation in their header"},
      {densities.others, "the labels do not lie on their organs",
       "give the labels of this CT, with the orientation in their header"},
      {compare_heights(shapes), "head and feet are exchanged", "correct the orientation of the CT and its labels"},
      {compare_depths(shapes), "front and back are exchanged", "correct the orientation of the CT and its labels"},
      {compare_sides(shapes), "left and right are exchanged", "correct the orientation of the CT and its labels"}};
  std::vector<std::string> notes;
  for (const auto& [tally, conclusion, remedy] : checks) {
    if (tally.mostly_against()) throw InputError(file, "", tally.against.front() + ": " + conclusion, remedy);
    for (const std::string& one : tally.against) notes.push_back("Look at the labels: " + one + ".");
  }
  return notes;
}

}  // namespace insonate
