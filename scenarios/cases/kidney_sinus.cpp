#include "scenarios/cases/kidney_sinus.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenarios/cases/mask_filters.h"

namespace insonate {
namespace {

constexpr double kHalfHilum_mm = 12;  // the lips of a kidney's hilum are up to 24 mm apart
constexpr double kMinSinus_ml = 1;
constexpr int kDensestGas_hu = -200;

/// A part of a volume.
struct Part {
  glm::ivec3 low{0}, size{0};
};

/// Returns the part around a structure, with a margin; nothing if it has no voxels.
std::optional<Part> part_around(const Volume<std::uint8_t>& labels, std::uint8_t value, const glm::ivec3& margin) {
  const glm::ivec3 size = labels.grid.size;
  glm::ivec3 low = size, high(-1);
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (const glm::ivec3 i(x, y, z); labels.at(i) == value) low = glm::min(low, i), high = glm::max(high, i);
  if (high.x < 0) return std::nullopt;
  low = glm::max(low - margin, 0);
  high = glm::min(high + margin, size - 1);
  return Part{low, high - low + 1};
}

template <typename Use>
void each_voxel(const Part& part, Use use) {
  for (int z = 0; z < part.size.z; ++z)
    for (int y = 0; y < part.size.y; ++y)
      for (int x = 0; x < part.size.x; ++x) use(glm::ivec3(x, y, z));
}

/// Returns the sinus within the part; all 0 if there is none.
Volume<std::uint8_t> find_sinus(const Case& subject, std::uint8_t kidney, const Part& part, const glm::ivec3& reach) {
  Volume<std::uint8_t> closed;
  closed.grid.size = part.size;
  each_voxel(part, [&](const glm::ivec3& i) { closed.voxels.push_back(subject.labels.at(part.low + i) == kidney); });
  filter_box(closed, reach, true);
  filter_box(closed, reach, false);
  each_voxel(part, [&](const glm::ivec3& i) {
    if (subject.labels.at(part.low + i) != 0 || subject.ct.at(part.low + i) <= kDensestGas_hu) closed.at(i) = 0;
  });
  Volume<std::uint8_t> sinus = closed;
  filter_box(sinus, glm::ivec3(1), false);
  keep_largest_piece(sinus);
  filter_box(sinus, glm::ivec3(1), true);
  for (std::size_t v = 0; v < sinus.voxels.size(); ++v) sinus.voxels[v] = sinus.voxels[v] && closed.voxels[v];
  return sinus;
}

}  // namespace

std::vector<std::string> label_kidney_sinuses(Case& subject) {
  const glm::dvec3 spacing = subject.labels.grid.spacing;
  const glm::ivec3 reach(glm::max(glm::round(kHalfHilum_mm / spacing), 1.0));
  std::vector<std::string> notes;
  for (const char* name : {"kidney_right", "kidney_left"}) {
    const std::string sinus_name = std::string(name) + "_sinus";
    const Label* kidney = subject.find_label(name);
    if (!kidney || subject.find_label(sinus_name)) continue;
    int value = 1;
    while (value < 256 && std::ranges::any_of(subject.label_table, [&](const Label& l) { return l.value == value; }))
      ++value;
    const auto part = part_around(subject.labels, kidney->value, reach + 1);
    if (value == 256 || !part) continue;
    const Volume<std::uint8_t> sinus = find_sinus(subject, kidney->value, *part, reach);
    const double ml = double(std::ranges::count(sinus.voxels, 1)) * spacing.x * spacing.y * spacing.z / 1000;
    if (ml < kMinSinus_ml) continue;
    each_voxel(*part, [&](const glm::ivec3& i) {
      if (sinus.at(i)) subject.labels.at(part->low + i) = std::uint8_t(value);
    });
    subject.label_table.push_back({std::uint8_t(value), sinus_name, "kidney_sinus"});
    notes.push_back("What '" + std::string(name) + "' encloses without a label, " + std::to_string(std::lround(ml)) +
                    " ml, became '" + sinus_name + "'.");
  }
  std::ranges::sort(subject.label_table, {}, &Label::value);
  return notes;
}

}  // namespace insonate
